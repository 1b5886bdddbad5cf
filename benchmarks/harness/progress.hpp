#pragma once

// Progress of long work on standard error, and interruption.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace definite {

// A bar with the remaining time, drawn at most ten times a second, and only on a terminal. Advance
// may be called by any thread.
class Progress {
 public:
  explicit Progress(bool show);
  ~Progress();

  // Starts a stage of `total` units of work; ends the one before.
  void Start(std::string stage, std::uint64_t total);
  void Advance(std::uint64_t units);
  void Finish();

 private:
  void Draw();

  bool show_;
  std::string stage_;
  std::uint64_t total_ = 0;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::int64_t> next_draw_{0};
  std::chrono::steady_clock::time_point start_;
};

// "1 h 02 min", "3 min 05 s", "12 s".
std::string Duration(double seconds);

// From here on Ctrl-C (and a polite kill) only sets a flag, that long work looks at once a block; a
// second one ends the program.
void CatchInterrupts();
bool Interrupted();
void InterruptForTest(bool interrupted);

}  // namespace definite
