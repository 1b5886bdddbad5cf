#pragma once

// Where the time of a job goes: configurations drawn and filtered from the first to the last, and
// the matrices of many elements summed into one.

#include <cstdint>
#include <string_view>
#include <vector>

#include "benchmarks/harness/progress.hpp"
#include "benchmarks/harness/sampling/distribution.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// One energy's job on so many threads: seconds of wall time for all configurations. Each stage that
// is computed is timed with those before it, for they run in one pass over registers.
struct JobTime {
  const KernelRow* row;  // packed
  int threads;
  std::int64_t count;
  double draw;                    // inputs, in both layouts
  double frame, hessian, packed;  // up to the frame, the filtered Hessian, its packed matrix

  double Total() const { return draw + packed; }
};

// Rows whose energy and filter have stages of their own, among those given.
std::vector<const KernelRow*> RowsWithStages(const std::vector<const KernelRow*>& rows);

// Draws and runs `count` configurations block by block, outputs in L1. Nothing if interrupted.
std::vector<JobTime> TimeJobs(const std::vector<const KernelRow*>& rows,
                              const Distribution& distribution, std::uint64_t seed,
                              std::int64_t count, const std::vector<int>& threads,
                              Progress& progress);

// Seconds of wall time for each element, of each round: of the row alone with its outputs in L1,
// and gathered, computed and added to a block-sparse matrix.
struct AssemblyTime {
  const KernelRow* row;
  int threads, colours;
  std::int64_t elements, blocks;
  std::vector<double> kernel, assembled;
};

// Rows that a solver would assemble with: packed, over lanes, of energies that are studied.
std::vector<const KernelRow*> RowsToAssemble(const std::vector<const KernelRow*>& rows);

// Elements on vertices of the unit cube, half as many as elements, each element's near each other
// in number.
std::vector<AssemblyTime> TimeAssemblies(const std::vector<const KernelRow*>& rows,
                                         std::uint64_t seed, std::int64_t elements,
                                         const std::vector<int>& threads, int rounds,
                                         Progress& progress);

}  // namespace definite
