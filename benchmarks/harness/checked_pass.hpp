#pragma once

// The checked pass of a sweep (docs/protocol.md, section 1).

#include "benchmarks/harness/sweep.hpp"

namespace definite {

// Checks the rows of one energy over the plan's configurations and fills in the statistics, which
// are the same for any number of threads. Returns false if interrupted: the statistics then cover
// the configurations before some index, all of them.
bool RunCheckedPass(const SweepPlan& plan, EnergyResult& result, Progress& progress);

}  // namespace definite
