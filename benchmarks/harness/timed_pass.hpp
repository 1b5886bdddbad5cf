#pragma once

// The timed pass of a sweep (docs/protocol.md, section 3).

#include "benchmarks/harness/sweep.hpp"

namespace definite {

inline constexpr int kRing = 16;  // configurations in the output ring, which stays in L1

// Of each block of configurations, the part that a row is timed on: an eigendecomposition takes so
// long that an eighth gives its time as well.
double TimedShare(const KernelRow& row);

int TimedRounds(std::uint64_t count);

// 0 to count - 1 in a random order that depends on seed and round alone: who is timed when.
std::vector<std::size_t> ShuffledOrder(std::size_t count, std::uint64_t seed, std::uint64_t round);

// Times the rows of one energy, all interleaved in random order over the same configurations, and
// appends a time for each round to each row. An interrupted round is dropped.
void RunTimedPass(const SweepPlan& plan, EnergyResult& result, Progress& progress);

}  // namespace definite
