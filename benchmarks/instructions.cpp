// A fixed workload for each row, between marks that callgrind counts: tools/instructions. Prints
// how it was built. Outside callgrind it counts nothing.

#include <valgrind/callgrind.h>

#include <cstdio>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {

namespace {

constexpr std::int64_t kConfigurations = 256;

// OpenBLAS picks its kernels by the processor it finds: the count would be the machine's.
bool IsCounted(const KernelRow& row) { return !row.filter.starts_with("numeric_lapack"); }

void Count(const KernelRow& row) {
  Batch batch(*row.energy);
  batch.Draw(*FindDistribution("active"), 42, 0, kConfigurations);
  AlignedDoubles outputs;
  outputs.Resize(static_cast<std::size_t>(row.outputs * kConfigurations));
  const auto run = [&] {
    row.run(batch.TilesX(row.lanes, 0), batch.TilesP(row.lanes, 0), outputs.Data(),
            kConfigurations / row.lanes);
  };
  run();  // what a first call alone does (a table looked up, a symbol bound) is not the row's
  CALLGRIND_TOGGLE_COLLECT;
  run();
  CALLGRIND_TOGGLE_COLLECT;
  CALLGRIND_DUMP_STATS_AT(row.name.c_str());
}

}  // namespace

}  // namespace definite

int main() {
  std::puts(definite::DescribeBuild().dump().c_str());
  for (const auto rows : {definite::AllKernels(), definite::AllOutputs()}) {
    for (const definite::KernelRow& row : rows) {
      if (definite::IsCounted(row)) definite::Count(row);
    }
  }
}
