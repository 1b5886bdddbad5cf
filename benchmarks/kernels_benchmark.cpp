// The rows, whatever their output, for users of Google Benchmark and its compare.py, and a
// loop written by hand beside them.
//
//   kernels_benchmark --benchmark_filter='analytic/f64x8' --benchmark_repetitions=9

#include <benchmark/benchmark.h>

#include <map>

#include "benchmarks/hand_fused.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {
namespace {

constexpr std::int64_t kCount = 4096;  // configurations, in L2
constexpr std::int64_t kRing = 16;     // outputs, in L1

// Inputs and outputs of one energy, at the same addresses for all its rows: how they lie to each
// other moves a kernel by 10 %.
struct Buffers {
  Batch batch;
  AlignedDoubles ring;

  explicit Buffers(const EnergyRow& energy) : batch(energy) {
    batch.Draw(*FindDistribution("active"), 42, 0, kCount);
    ring.Resize(static_cast<std::size_t>(energy.dofs * energy.dofs * kRing));  // the dense output's
  }

  static Buffers& Of(const EnergyRow& energy) {
    static std::map<const EnergyRow*, Buffers> all;
    return all.try_emplace(&energy, energy).first->second;
  }
};

void RunTiles(benchmark::State& state, const EnergyRow& energy, TileFunction run, int lanes) {
  Buffers& buffers = Buffers::Of(energy);
  for (auto _ : state) {
    for (std::int64_t i = 0; i < kCount; i += kRing) {
      run(buffers.batch.TilesX(lanes, i), buffers.batch.TilesP(lanes, i), buffers.ring.Data(),
          kRing / lanes);
      benchmark::ClobberMemory();
    }
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}

}  // namespace
}  // namespace definite

int main(int argc, char** argv) {
  using namespace definite;
  for (const std::span<const KernelRow> rows : {AllKernels(), AllOutputs()}) {
    for (const KernelRow& row : rows) {
      if (!FindDistribution("active")->supports(row.energy->stencil)) continue;
      benchmark::RegisterBenchmark(row.name.c_str(), [&row](benchmark::State& state) {
        RunTiles(state, *row.energy, row.run, row.lanes);
      });
    }
  }
  const KernelRow* row = FindKernel("collision/vertex_face/signed/quadratic/analytic/f64x8");
  benchmark::RegisterBenchmark("hand_fused/analytic/f64x8", [row](benchmark::State& state) {
    RunTiles(state, *row->energy, HandFusedAnalytic, row->lanes);
  });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
