#include "benchmarks/speed/stages.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <string>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/timed_pass.hpp"
#include "kernels/assembly/block_sparse.hpp"

namespace definite {

namespace {

constexpr std::int64_t kBlock = 4096;  // configurations drawn at once, in L2
constexpr std::int64_t kAtOnce = 32;   // outputs in L1

const KernelRow* OutputOf(const KernelRow& row, std::string_view output) {
  const std::string name = row.name + "/" + std::string(output);
  const auto at = std::ranges::find(AllOutputs(), name, &KernelRow::name);
  return at == AllOutputs().end() ? nullptr : &*at;
}

double StageTime(const KernelRow& row, const Batch& batch, AlignedDoubles& ring) {
  const double start = WallSeconds();
  for (std::int64_t i = 0; i < batch.Size(); i += kAtOnce) {
    const std::int64_t size = std::min(kAtOnce, batch.Size() - i);
    row.run(batch.TilesX(row.lanes, i), batch.TilesP(row.lanes, i), ring.Data(), size / row.lanes);
    asm volatile("" : : "r"(ring.Data()) : "memory");  // the outputs count as used
  }
  return WallSeconds() - start;
}

// Vertices in the unit cube, and elements of vertices that differ by at most 16 in number.
struct Mesh {
  int vertices;
  std::vector<double> x, p;
  std::vector<int> elements;

  Mesh(const EnergyRow& energy, std::uint64_t seed, std::int64_t count)
      : vertices(static_cast<int>(std::max<std::int64_t>(count / 2, 17))) {
    Draws draws(StreamId("assembly"), seed, 0);
    const auto below = [&draws](int n) { return static_cast<int>(draws.Uniform() * n); };
    for (int i = 0; i < 3 * vertices; ++i) x.push_back(draws.Uniform());
    const auto size = static_cast<std::size_t>(energy.dofs / 3);
    for (std::int64_t e = 0; e < count; ++e) {
      const int first = below(vertices - 16);
      std::vector<int> own;
      while (own.size() < size) {
        const int v = first + below(17);
        if (std::ranges::find(own, v) == own.end()) own.push_back(v);
      }
      elements.insert(elements.end(), own.begin(), own.end());
      for (const Parameter& parameter : energy.parameters) {
        p.push_back(parameter.name == "eps" ? 1 : parameter.value);  // as `paper` has it
      }
    }
  }
};

}  // namespace

std::vector<const KernelRow*> RowsWithStages(const std::vector<const KernelRow*>& rows) {
  std::vector<const KernelRow*> found;
  std::ranges::copy_if(rows, std::back_inserter(found), [](const KernelRow* row) {
    return OutputOf(*row, "frame") && OutputOf(*row, "framed");
  });
  return found;
}

std::vector<JobTime> TimeJobs(const std::vector<const KernelRow*>& rows,
                              const Distribution& distribution, std::uint64_t seed,
                              std::int64_t count, const std::vector<int>& threads,
                              Progress& progress) {
  std::vector<JobTime> jobs;
  const std::int64_t blocks = (count + kBlock - 1) / kBlock;
  progress.Start("stages", static_cast<std::uint64_t>(blocks) * rows.size() * threads.size());
  for (const KernelRow* row : rows) {
    const std::array<const KernelRow*, 3> stages = {OutputOf(*row, "frame"),
                                                    OutputOf(*row, "framed"), row};
    int outputs = 0;
    for (const KernelRow* stage : stages) outputs = std::max(outputs, stage->outputs);
    for (int team : threads) {
      // Of the slowest thread in each stage: the others wait for it.
      double draw = 0, frame = 0, hessian = 0, packed = 0;
#pragma omp parallel num_threads(team) reduction(max : draw, frame, hessian, packed)
      {
        Batch batch(*row->energy);
        AlignedDoubles ring;
        ring.Resize(static_cast<std::size_t>(outputs * kAtOnce));
        double drawing = 0, seconds[3] = {};
#pragma omp for schedule(static)
        for (std::int64_t block = 0; block < blocks; ++block) {
          if (Interrupted()) continue;
          const std::int64_t first = block * kBlock, size = std::min(kBlock, count - first);
          const double start = WallSeconds();
          batch.Draw(distribution, seed, static_cast<std::uint64_t>(first), WholeTiles(size));
          drawing += WallSeconds() - start;
          const auto round = static_cast<std::uint64_t>(block);
          for (std::size_t s : ShuffledOrder(stages.size(), seed, round)) {
            seconds[s] += StageTime(*stages[s], batch, ring);
          }
          progress.Advance(1);
        }
        draw = drawing;
        frame = seconds[0];
        hessian = seconds[1];
        packed = seconds[2];
      }
      if (Interrupted()) return {};
      jobs.push_back({row, team, count, draw, frame, hessian, packed});
    }
  }
  return jobs;
}

std::vector<const KernelRow*> RowsToAssemble(const std::vector<const KernelRow*>& rows) {
  std::vector<const KernelRow*> found;
  std::ranges::copy_if(rows, std::back_inserter(found), [](const KernelRow* row) {
    return row->lanes > 1 && OutputOf(*row, "dense");
  });
  return found;
}

std::vector<AssemblyTime> TimeAssemblies(const std::vector<const KernelRow*>& rows,
                                         std::uint64_t seed, std::int64_t elements,
                                         const std::vector<int>& threads, int rounds,
                                         Progress& progress) {
  std::vector<AssemblyTime> times;
  progress.Start("assembly", rows.size() * static_cast<std::uint64_t>(rounds));
  for (const KernelRow* row : rows) {
    const Mesh mesh(*row->energy, seed, elements);
    const ElementList list{row->energy->dofs / 3, mesh.elements};
    BlockSparse matrix(mesh.vertices, {&list, 1});
    const Assembly assembly(matrix, list);
    Batch batch(*row->energy);
    batch.Draw(*FindDistribution("paper"), seed, 0, kBlock);
    AlignedDoubles ring;
    ring.Resize(static_cast<std::size_t>(row->outputs * kAtOnce));
    const std::size_t first = times.size();
    for (int team : threads) {
      times.push_back({row, team, assembly.Colours(), elements, std::ssize(matrix.column), {}, {}});
    }
    for (int round = -1; round < rounds && !Interrupted(); ++round) {
      const auto order = static_cast<std::uint64_t>(round + 1);
      for (std::size_t t : ShuffledOrder(threads.size(), seed, order)) {
        AssemblyTime& time = times[first + t];
        const double kernel = StageTime(*row, batch, ring);
        matrix.SetZero();
        const double start = WallSeconds();
        assembly.Add(*row, mesh.x, mesh.p, time.threads, matrix);
        const double assembled = WallSeconds() - start;
        if (round < 0) continue;  // it warmed the caches
        time.kernel.push_back(kernel / static_cast<double>(kBlock));
        time.assembled.push_back(assembled / static_cast<double>(elements));
      }
      if (round >= 0) progress.Advance(1);
    }
  }
  if (Interrupted()) return {};
  return times;
}

}  // namespace definite
