#include "benchmarks/speed/speed.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/timed_pass.hpp"
#include "kernels/core/lanes.hpp"

namespace definite {

namespace {

constexpr std::int64_t kInputs = 4096;   // configurations of a thread, in L2
constexpr double kShortest = 1e-3;       // seconds of one timing
constexpr std::int64_t kCounted = 1024;  // configurations whose operations are counted

// Outputs go round in the ring and on from where the row before left off, so that one larger than a
// cache is always written from outside it.
class Ring {
 public:
  explicit Ring(Level level) : size_(RingBytes(level) / static_cast<std::int64_t>(sizeof(double))) {
    numbers_.Resize(static_cast<std::size_t>(size_));
    std::fill_n(numbers_.Data(), size_, 0.5);  // what is applied and added to
  }

  // Configurations that a row writes at once.
  std::int64_t Chunk(const KernelRow& row) const {
    const std::int64_t fit = size_ / row.outputs / kTile * kTile;
    return std::clamp<std::int64_t>(fit, kTile, 32);
  }
  double* Next(std::int64_t numbers) {
    if (at_ + numbers > size_) at_ = 0;
    double* const next = numbers_.Data() + at_;
    at_ += (numbers + 7) / 8 * 8;
    return next;
  }

 private:
  std::int64_t size_, at_ = 0;
  AlignedDoubles numbers_;
};

// One thread's inputs and outputs of an energy.
struct Workplace {
  Batch batch;
  Ring ring;

  void Run(const KernelRow& row, std::int64_t repetitions) {
    const std::int64_t chunk = ring.Chunk(row);
    for (std::int64_t r = 0; r < repetitions; ++r) {
      for (std::int64_t i = 0; i < kInputs; i += chunk) {
        const std::int64_t size = std::min(chunk, kInputs - i);
        double* const out = ring.Next(size * row.outputs);
        row.run(batch.TilesX(row.lanes, i), batch.TilesP(row.lanes, i), out, size / row.lanes);
        asm volatile("" : : "r"(out) : "memory");  // the outputs count as used
      }
    }
  }
};

struct Seconds {
  double wall, cpu;
};

// Of each thread's work on a row, all starting together.
Seconds TimeOf(const KernelRow& row, std::int64_t repetitions,
               std::vector<std::unique_ptr<Workplace>>& places) {
  const auto threads = static_cast<int>(places.size());
  double wall = 0, cpu = 0;
#pragma omp parallel num_threads(threads) reduction(max : wall) reduction(+ : cpu)
  {
    Workplace& mine = *places[static_cast<std::size_t>(omp_get_thread_num())];
    mine.Run(row, 1);  // inputs and code into the caches
#pragma omp barrier
    const double wall_start = WallSeconds(), cpu_start = ThreadSeconds();
    mine.Run(row, repetitions);
    wall = WallSeconds() - wall_start;
    cpu = ThreadSeconds() - cpu_start;
  }
  return {wall, cpu};
}

Operations operator+(Operations a, const Operations& b) {
  a.additions += b.additions;
  a.multiplications += b.multiplications;
  a.fused += b.fused;
  a.divisions += b.divisions;
  a.roots += b.roots;
  a.logs += b.logs;
  a.stores += b.stores;
  return a;
}

Floor FloorOf(const KernelRow& row, const Batch& batch, const Roofline& roofline, Level level,
              int threads) {
  Operations sum;
  for (std::int64_t i = 0; i < kCounted; ++i) sum = sum + row.count(batch.X(i), batch.P(i));
  const auto each = [&](std::int64_t operations) {
    return static_cast<double>(operations) / static_cast<double>(kCounted * threads);
  };
  Floor floor;
  floor.counted = kCounted;
  floor.operations = sum;
  // Where additions have units of their own, multiplications must still make do with theirs.
  floor.arithmetic = std::max(each(sum.Arithmetic()) / roofline.arithmetic,
                              each(sum.multiplications + sum.fused) / roofline.fused) /
                     kNativeLanes;
  floor.division = each(sum.divisions) / kNativeLanes / roofline.divisions +
                   each(sum.roots) / kNativeLanes / roofline.roots;
  floor.stores = each(sum.stores) * sizeof(double) / roofline.Stores(level);
  return floor;
}

const SpeedRow* Baseline(const std::vector<SpeedRow>& rows, const SpeedRow& of,
                         std::string_view filter) {
  for (const SpeedRow& r : rows) {
    if (r.row->energy == of.row->energy && r.level == of.level && r.threads == of.threads &&
        r.row->filter == filter && r.row->scalar == "f64" && r.row->output == "packed") {
      return &r;
    }
  }
  return nullptr;
}

std::optional<MedianEstimate> RatioTo(const SpeedRow* baseline, const SpeedRow& row) {
  if (!baseline) return std::nullopt;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < row.seconds.size(); ++i) {
    ratios.push_back(baseline->seconds[i] / row.seconds[i]);
  }
  return EstimateMedian(ratios);
}

// One energy at one level on so many threads.
void TimeRows(const SpeedPlan& plan, std::vector<SpeedRow>& rows, SpeedResult& result,
              Progress& progress) {
  const SpeedRow& any = rows.front();
  std::vector<std::unique_ptr<Workplace>> places;
  for (int t = 0; t < any.threads; ++t) {
    places.push_back(
        std::make_unique<Workplace>(Workplace{Batch(*any.row->energy), Ring(any.level)}));
    places.back()->batch.Draw(*plan.distribution, plan.seed,
                              static_cast<std::uint64_t>(t * kInputs), kInputs);
  }
  std::vector<std::int64_t> repetitions;
  for (SpeedRow& r : rows) {
    const Seconds once = TimeOf(*r.row, 1, places);
    repetitions.push_back(std::max<std::int64_t>(1, std::llround(kShortest / once.wall)));
    if (r.row->count) {
      r.floor = FloorOf(*r.row, places.front()->batch, result.roofline, r.level, r.threads);
    }
  }
  Seconds all{};
  for (int round = 0; round < plan.rounds && !Interrupted(); ++round) {
    for (std::size_t i : ShuffledOrder(rows.size(), plan.seed, static_cast<std::uint64_t>(round))) {
      const Seconds s = TimeOf(*rows[i].row, repetitions[i], places);
      all.wall += s.wall * any.threads;
      all.cpu += s.cpu;
      const double hessians = static_cast<double>(kInputs * repetitions[i] * any.threads);
      rows[i].seconds.push_back((any.threads == 1 ? s.cpu : s.wall) / hessians);
    }
    progress.Advance(1);
  }
  result.noisy = result.noisy || all.cpu < 0.95 * all.wall;
  for (SpeedRow& r : rows) {
    r.to_numeric = RatioTo(Baseline(rows, r, "numeric"), r);
    r.to_gauss_newton = RatioTo(Baseline(rows, r, "gauss_newton"), r);
  }
  result.rows.insert(result.rows.end(), rows.begin(), rows.end());
}

}  // namespace

double Floor::Seconds() const { return std::max({arithmetic, division, stores}); }

std::string_view Floor::Binds() const {
  if (Seconds() == arithmetic) return "arithmetic";
  return Seconds() == division ? "division" : "stores";
}

std::string_view LevelName(Level level) {
  constexpr std::string_view kNames[] = {"L1", "L2", "memory"};
  return kNames[static_cast<int>(level)];
}

SpeedResult RunSpeed(const SpeedPlan& plan, Progress& progress) {
  SpeedResult result;
  result.plan = plan;
  if (double load; getloadavg(&load, 1) == 1) result.load_before = load;
  result.roofline = MeasureRoofline();
  std::vector<const EnergyRow*> energies;
  for (const KernelRow* row : plan.rows) {
    if (std::ranges::find(energies, row->energy) == energies.end()) energies.push_back(row->energy);
  }
  progress.Start("timing", energies.size() * plan.levels.size() * plan.threads.size() *
                               static_cast<std::uint64_t>(plan.rounds));
  for (const EnergyRow* energy : energies) {
    for (Level level : plan.levels) {
      for (int threads : plan.threads) {
        if (Interrupted()) break;
        std::vector<SpeedRow> rows;
        for (const KernelRow* row : plan.rows) {
          if (row->energy == energy) rows.push_back({row, level, threads, {}, {}, {}, {}});
        }
        TimeRows(plan, rows, result, progress);
      }
    }
  }
  if (plan.configurations > 0) {
    result.jobs = TimeJobs(RowsWithStages(plan.rows), *plan.distribution, plan.seed,
                           plan.configurations, plan.threads, progress);
  }
  if (plan.elements > 0) {
    result.assemblies = TimeAssemblies(RowsToAssemble(plan.rows), plan.seed, plan.elements,
                                       plan.threads, plan.rounds, progress);
  }
  progress.Finish();
  result.partial = Interrupted();
  return result;
}

}  // namespace definite
