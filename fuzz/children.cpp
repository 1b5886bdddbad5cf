#include "fuzz/children.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <system_error>
#include <vector>

#include "benchmarks/harness/progress.hpp"

namespace definite::fuzz {

namespace {

struct Child {
  pid_t process;
  int from;  // what it writes comes out here
  std::size_t task;
  std::string text;
};

[[noreturn]] void Fail(const char* doing) {
  throw std::system_error(errno, std::generic_category(), doing);
}

void LimitTime(double seconds) {
  double whole;
  const double part = std::modf(seconds, &whole);
  const itimerval limit = {{0, 0},
                           {static_cast<time_t>(whole), static_cast<suseconds_t>(1e6 * part)}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

bool WriteAll(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(to, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void Work(int to, double seconds, const std::function<std::string(std::size_t)>& work,
                       std::size_t task) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // that is for the parent to answer
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGPROF, SIG_DFL);
  LimitTime(seconds);
  int code = 1;
  try {
    if (WriteAll(to, work(task))) code = 0;
  } catch (const std::exception& error) {
    WriteAll(to, error.what());
  }
  _exit(code);
}

Child Start(std::size_t task, double seconds, const std::function<std::string(std::size_t)>& work) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) Fail("cannot make a pipe");
  std::fflush(nullptr);  // or the child would have it to write too
  const pid_t process = fork();
  if (process < 0) Fail("cannot make a process");
  if (process == 0) Work(ends[1], seconds, work, task);
  close(ends[1]);
  return {process, ends[0], task, {}};
}

// True at the end of what it writes.
bool ReadSome(Child& child) {
  std::array<char, 1 << 16> buffer;
  const ssize_t count = read(child.from, buffer.data(), buffer.size());
  if (count > 0) child.text.append(buffer.data(), static_cast<std::size_t>(count));
  return count == 0 || (count < 0 && errno != EINTR);
}

Ended Await(Child& child) {
  close(child.from);
  int status = 0;
  while (waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {true, std::move(child.text)};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) return {false, "no end in time"};
  if (WIFSIGNALED(status)) return {false, strsignal(WTERMSIG(status))};
  return {false, child.text.empty() ? fmt::format("exit code {}", WEXITSTATUS(status))
                                    : std::move(child.text)};
}

}  // namespace

void InChildren(std::size_t count, int processes, double cpu_seconds,
                const std::function<std::string(std::size_t)>& work,
                const std::function<void(std::size_t, const Ended&)>& done) {
  std::vector<Child> running;
  std::size_t next = 0;
  while ((next < count || !running.empty()) && !Interrupted()) {
    while (next < count && running.size() < static_cast<std::size_t>(processes)) {
      running.push_back(Start(next++, cpu_seconds, work));
    }
    std::vector<pollfd> waiting;
    for (const Child& child : running) waiting.push_back({child.from, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) Fail("cannot poll");
    for (std::size_t i = waiting.size(); i-- > 0;) {
      if (waiting[i].revents == 0 || !ReadSome(running[i])) continue;
      Child child = std::move(running[i]);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      done(child.task, Await(child));
    }
  }
  for (Child& child : running) kill(child.process, SIGKILL);
  for (Child& child : running) Await(child);
}

SharedNote::SharedNote() {
  void* memory = mmap(nullptr, 2 * sizeof(std::size_t), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) Fail("cannot share memory");
  numbers_ = static_cast<volatile std::size_t*>(memory);
}

SharedNote::~SharedNote() { munmap(const_cast<std::size_t*>(numbers_), 2 * sizeof(std::size_t)); }

void SharedNote::Write(std::size_t a, std::size_t b) {
  numbers_[0] = a;
  numbers_[1] = b;
}

}  // namespace definite::fuzz
