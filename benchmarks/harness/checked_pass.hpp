#pragma once

// The checked pass of a sweep (docs/protocol.md, section 1).

#include "benchmarks/harness/sweep.hpp"

namespace definite {

// Checks the rows of one energy over blocks of the plan, in their order, for about so many seconds,
// or until interrupted; blocks that were begun are finished. Adds to the statistics, which are the
// same for any number of threads, and returns how many blocks it did.
std::size_t CheckBlocks(const SweepPlan& plan, std::span<const Block> blocks, double seconds,
                        EnergyResult& result, Progress& progress);

// Looks at the worst case of each figure of each row again, in float128.
void ExamineWorstCases(const SweepPlan& plan, EnergyResult& result);

}  // namespace definite
