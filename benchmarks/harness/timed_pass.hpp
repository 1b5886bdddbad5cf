#pragma once

// The timed pass of a sweep (docs/protocol.md, section 3).

#include "benchmarks/harness/sweep.hpp"

namespace definite {

inline constexpr int kRing = 16;  // configurations in the output ring, which stays in L1

int TimedRounds(std::uint64_t count);

// Times the rows of one energy, all interleaved in random order over the same configurations, and
// appends a time for each round to each row. An interrupted round is dropped.
void RunTimedPass(const SweepPlan& plan, EnergyResult& result, Progress& progress);

}  // namespace definite
