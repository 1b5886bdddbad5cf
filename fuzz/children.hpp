#pragma once

// Work in child processes: a crash or a hang of one task ends that task alone.

#include <cstddef>
#include <functional>
#include <string>

namespace definite::fuzz {

struct Ended {
  bool well;         // the text is whole
  std::string text;  // what the task returned; if it did not end well, how it ended
};

// Runs the tasks 0 .. count-1, at most `processes` at a time, each for at most so many seconds of
// processor time; done(task, ended) is called here, in any order. When interrupted (progress.hpp),
// what still runs is thrown away. The caller must not have used OpenMP before.
void InChildren(std::size_t count, int processes, double cpu_seconds,
                const std::function<std::string(std::size_t)>& work,
                const std::function<void(std::size_t, const Ended&)>& done);

// Numbers that a child writes and that are there when it has died.
class SharedNote {
 public:
  SharedNote();
  ~SharedNote();
  SharedNote(const SharedNote&) = delete;
  SharedNote& operator=(const SharedNote&) = delete;

  void Write(std::size_t a, std::size_t b);
  std::size_t First() const { return numbers_[0]; }
  std::size_t Second() const { return numbers_[1]; }

 private:
  volatile std::size_t* numbers_;
};

}  // namespace definite::fuzz
