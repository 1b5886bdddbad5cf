#include "tools/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "tools/command_line.hpp"

namespace definite {

OutputFile::OutputFile(std::string option, std::string path)
    : option_(std::move(option)), path_(std::move(path)) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large is an error of write(), not the end
  std::signal(SIGPIPE, SIG_IGN);
  struct stat status;
  if (path_ == "-") {
    descriptor_ = STDOUT_FILENO;
  } else if (stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) Fail("open");
  } else {
    temporary_ = fmt::format("{}.{}.tmp", path_, getpid());
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      temporary_.clear();
      Fail("create");
    }
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ > STDOUT_FILENO) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::Commit(const std::string& content) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t n = write(descriptor_, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) Fail("write");
    done += static_cast<std::size_t>(n);
  }
  if (temporary_.empty()) return;
  if (fsync(descriptor_) != 0) Fail("write");
  if (rename(temporary_.c_str(), path_.c_str()) != 0) Fail("rename onto");
  temporary_.clear();
}

void OutputFile::Fail(const std::string& doing) const {
  throw UsageError(fmt::format("{} '{}': cannot {} it: {}", option_, path_, doing,
                               std::strerror(errno)));
}

}  // namespace definite
