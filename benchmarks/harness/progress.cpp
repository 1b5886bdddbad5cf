#include "benchmarks/harness/progress.hpp"

#include <fmt/core.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <utility>

namespace definite {

namespace {

// Other threads read what a signal writes.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void OnInterrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
}

bool Interrupted() { return interrupted; }
void InterruptForTest(bool value) { interrupted = value; }

std::string Duration(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

Progress::Progress(bool show) : show_(show) {}

Progress::~Progress() { Finish(); }

void Progress::Start(std::string stage, std::uint64_t total) {
  Finish();
  stage_ = std::move(stage);
  total_ = total;
  done_ = 0;
  next_draw_ = 0;
  start_ = std::chrono::steady_clock::now();
}

void Progress::Advance(std::uint64_t units) {
  done_ += units;
  if (!show_) return;
  using std::chrono::duration_cast, std::chrono::milliseconds;
  const std::int64_t now =
      duration_cast<milliseconds>(std::chrono::steady_clock::now() - start_).count();
  std::int64_t due = next_draw_;
  // Only the thread that moves the next time on draws.
  if (now >= due && next_draw_.compare_exchange_strong(due, now + 100)) Draw();
}

void Progress::Draw() {
  constexpr int kWidth = 24;  // the line fits 80 columns
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double part = total_ ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
  const int filled = static_cast<int>(part * kWidth);
  const std::string left = part > 0.01 ? Duration(elapsed * (1 - part) / part) + " left" : "";
  fmt::print(stderr, "\r\033[K{:<14}[{:=<{}}{:<{}}] {:3.0f} %  {:>10}  {}", stage_, "", filled, "",
             kWidth - filled, 100 * part, Duration(elapsed), left);
  std::fflush(stderr);
}

void Progress::Finish() {
  if (show_ && !stage_.empty()) {
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
  stage_.clear();
}

}  // namespace definite
