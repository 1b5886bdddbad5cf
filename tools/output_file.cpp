#include "tools/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "tools/command_line.hpp"

namespace definite {

OutputFile::OutputFile(std::string option, std::string path)
    : option_(std::move(option)), path_(std::move(path)), target_(path_) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large is an error of write(), not the end
  std::signal(SIGPIPE, SIG_IGN);
  struct stat status;
  if (path_.empty()) {
    throw UsageError(option_ + " '': expected the name of a file, or - for standard output");
  }
  if (path_ == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  if (stat(path_.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) {
      descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
      if (descriptor_ < 0) Fail("open");
      return;
    }
    target_ = std::filesystem::canonical(path_).string();  // a link stays one
  }
  CreateTemporary();
  RemoveTemporary();
}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) {
    RemoveTemporary();
  } else if (descriptor_ > STDOUT_FILENO) {
    close(descriptor_);
  }
}

void OutputFile::Commit(const std::string& content) {
  const bool direct = descriptor_ >= 0;
  if (!direct) CreateTemporary();
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t n = write(descriptor_, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) Fail("write");
    done += static_cast<std::size_t>(n);
  }
  if (direct) return;
  if (fsync(descriptor_) != 0) Fail("write");
  if (rename(temporary_.c_str(), target_.c_str()) != 0) Fail("rename onto");
  close(descriptor_);
  descriptor_ = -1;
  temporary_.clear();
}

void OutputFile::CreateTemporary() {
  temporary_ = fmt::format("{}.{}.tmp", target_, getpid());
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    temporary_.clear();
    Fail("create");
  }
}

void OutputFile::RemoveTemporary() {
  close(descriptor_);
  descriptor_ = -1;
  unlink(temporary_.c_str());
  temporary_.clear();
}

void OutputFile::Fail(const std::string& doing) const {
  throw UsageError(
      fmt::format("{} '{}': cannot {} it: {}", option_, path_, doing, std::strerror(errno)));
}

}  // namespace definite
