#include "benchmarks/harness/timed_pass.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "benchmarks/harness/blocks.hpp"
#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {

namespace {

constexpr std::int64_t kBlock = 4096;  // at most drawn before the clock starts: inputs in L2
constexpr int kMaxRounds = 15;

// Seconds that a row takes over the first `size` of the batch, its outputs going round in the ring.
double TimeOf(const KernelRow& row, const Batch& batch, std::int64_t size, double* ring,
              double (*clock)()) {
  const double start = clock();
  for (std::int64_t i = 0; i < size; i += kRing) {
    const std::int64_t chunk = std::min<std::int64_t>(kRing, size - i);
    row.run(batch.TilesX(row.lanes, i), batch.TilesP(row.lanes, i), ring, chunk / row.lanes);
    asm volatile("" : : "r"(ring) : "memory");  // the outputs count as used
  }
  return clock() - start;
}

// The configurations of a block by whether the energy acts. Each part is timed on its own, so that
// one measurement gives the time of the active ones and that of all.
class Parts {
 public:
  explicit Parts(const EnergyRow& energy) : energy_(energy), batch_{Batch(energy), Batch(energy)} {}

  void Split(const Batch& block, std::int64_t size) {
    for (auto& indices : indices_) indices.clear();
    for (std::int64_t i = 0; i < size; ++i) {
      double classification[3];
      energy_.classify(block.X(i), block.P(i), classification, 1);
      indices_[classification[0] == 1 ? kActive : kIdle].push_back(i);
    }
    for (std::size_t part : {kActive, kIdle}) {
      if (Count(part)) batch_[part].Take(block, indices_[part]);
    }
  }

  static constexpr std::size_t kActive = 0, kIdle = 1;
  std::int64_t Count(std::size_t part) const { return std::ssize(indices_[part]); }

  // Seconds for the configurations of one part, from those that the row is timed on; what fills up
  // its last tile is taken off.
  double TimeOf(std::size_t part, const KernelRow& row, double* ring, double (*clock)()) const {
    if (!Count(part)) return 0;
    const std::int64_t size =
        WholeTiles(std::llround(std::ceil(TimedShare(row) * static_cast<double>(Count(part)))));
    return definite::TimeOf(row, batch_[part], size, ring, clock) *
           static_cast<double>(Count(part)) / static_cast<double>(size);
  }

 private:
  const EnergyRow& energy_;
  Batch batch_[2];
  std::vector<std::int64_t> indices_[2];
};

}  // namespace

std::vector<std::size_t> ShuffledOrder(std::size_t count, std::uint64_t seed, std::uint64_t round) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  Draws draws(StreamId("order of rows"), seed, round);
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(draws.Uniform() * static_cast<double>(i))]);
  }
  return order;
}

double TimedShare(const KernelRow& row) { return IsSampled(row) ? 0.125 : 1; }

int TimedRounds(std::uint64_t count) {
  return static_cast<int>(std::clamp<std::uint64_t>(count / 512, 1, kMaxRounds));
}

void RunTimedPass(const SweepPlan& plan, EnergyResult& result, Progress& progress) {
  const EnergyRow& energy = *result.energy;
  std::vector<RowResult>& rows = result.rows;
  const std::vector<Block> shard = BlocksOf(plan.count, plan.shard);
  if (shard.empty()) return;
  const std::uint64_t begin = shard.front().first, count = shard.back().end - begin;
  const int rounds = TimedRounds(count);
  const auto threads = static_cast<std::size_t>(plan.threads);
  for (int round = 0; round < rounds; ++round) {
    const auto round_begin = [&](int r) {
      return begin + count * static_cast<std::uint64_t>(r) / static_cast<std::uint64_t>(rounds);
    };
    const std::uint64_t first = round_begin(round), last = round_begin(round + 1);
    // Equal blocks, as many for each thread, so that none waits for another.
    const auto size_of_round = static_cast<std::int64_t>(last - first);
    const std::int64_t blocks = CeilDivide(size_of_round, kBlock * plan.threads) * plan.threads;
    const std::int64_t block_size = WholeTiles(CeilDivide(size_of_round, blocks));
    // Of each thread: seconds in each row, of the active and the idle, and how many there were.
    struct Share {
      std::vector<std::array<double, 2>> seconds;
      std::array<std::int64_t, 2> counts{};
      double cpu = 0, wall = 0;
    };
    std::vector<Share> shares(threads, {std::vector<std::array<double, 2>>(rows.size()), {}, 0, 0});
    bool stopped = false;
#pragma omp parallel num_threads(plan.threads)
    {
      Share& mine = shares[static_cast<std::size_t>(omp_get_thread_num())];
      // One thread: its processor time. More: wall time, since they share the machine.
      double (*const clock)() = threads == 1 ? ThreadSeconds : WallSeconds;
      Batch block_of_all(energy, plan.overrides);
      Parts parts(energy);
      AlignedDoubles ring;
      std::size_t outputs = 0;
      for (const RowResult& r : rows) {
        outputs = std::max(outputs, static_cast<std::size_t>(r.row->outputs));
      }
      ring.Resize(outputs * kRing);
#pragma omp for schedule(static)
      for (std::int64_t block = 0; block < blocks; ++block) {
        if (Interrupted()) {
#pragma omp atomic write
          stopped = true;
          continue;
        }
        const std::uint64_t at = first + static_cast<std::uint64_t>(block * block_size);
        if (at >= last) continue;  // fewer tiles than threads
        const auto size = std::min(block_size, static_cast<std::int64_t>(last - at));
        mine.cpu -= ThreadSeconds();
        mine.wall -= WallSeconds();
        block_of_all.Draw(*plan.distribution, plan.seed, at, WholeTiles(size));
        parts.Split(block_of_all, size);
        for (std::size_t r : ShuffledOrder(rows.size(), plan.seed, at)) {
          for (std::size_t part : {Parts::kActive, Parts::kIdle}) {
            mine.seconds[r][part] += parts.TimeOf(part, *rows[r].row, ring.Data(), clock);
          }
        }
        for (std::size_t part : {Parts::kActive, Parts::kIdle}) {
          mine.counts[part] += parts.Count(part);
        }
        mine.cpu += ThreadSeconds();
        mine.wall += WallSeconds();
        progress.Advance(static_cast<std::uint64_t>(size));
      }
    }
    if (stopped) return;
    std::int64_t active = 0, all = 0;
    for (const Share& share : shares) {
      active += share.counts[Parts::kActive];
      all += share.counts[Parts::kActive] + share.counts[Parts::kIdle];
      result.timed_cpu += share.cpu;
      result.timed_wall += share.wall;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      // The threads run side by side: the last one to finish counts.
      double slowest = 0, slowest_active = 0;
      for (const Share& share : shares) {
        const auto [of_active, of_idle] = share.seconds[r];
        slowest = std::max(slowest, of_active + of_idle);
        slowest_active = std::max(slowest_active, of_active);
      }
      rows[r].timing.all.push_back(slowest / static_cast<double>(all));
      if (active) rows[r].timing.active.push_back(slowest_active / static_cast<double>(active));
    }
  }
}

}  // namespace definite
