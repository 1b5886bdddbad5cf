#pragma once

// Two programs timed in turn, so that whatever the machine does meets both.

#include <string>
#include <vector>

#include "benchmarks/compare/compare.hpp"
#include "benchmarks/harness/progress.hpp"

namespace definite {

struct PairedPlan {
  std::string base, now;               // programs
  std::vector<std::string> arguments;  // of their `sweep`, which only times, on one thread
  int rounds = 15;
};

struct PairedTimes {
  std::vector<Timed> base, now;
  bool partial = false;  // interrupted
};

// Each round runs base, new, new, base; its time of a row is the geometric mean of the two medians,
// so that a drift of the machine cancels. Throws CompareError if a program fails.
PairedTimes RunPaired(const PairedPlan& plan, Progress& progress);

}  // namespace definite
