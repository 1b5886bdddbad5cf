#include "benchmarks/harness/timed_pass.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <numeric>

#include "benchmarks/harness/batch.hpp"

namespace definite {

namespace {

constexpr std::int64_t kBlock = 4096;  // configurations drawn before the clock starts: inputs in L2
constexpr int kMaxRounds = 15;

double ThreadSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Runs a row over the batch into the ring.
void RunInto(const KernelRow& row, const Batch& batch, double* ring) {
  for (std::int64_t i = 0; i < batch.Size(); i += kRing) {
    const std::int64_t size = std::min<std::int64_t>(kRing, batch.Size() - i);
    row.run(batch.TilesX(row.lanes, i), batch.TilesP(row.lanes, i), ring, size / row.lanes);
    asm volatile("" : : "r"(ring) : "memory");  // the outputs count as used
  }
}

// The rows in a random order that depends on the block alone.
std::vector<std::size_t> Shuffled(std::size_t count, std::uint64_t seed, std::uint64_t block) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  Draws draws(StreamId("order of rows"), seed, block);
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(draws.Uniform() *
                                                           static_cast<double>(i))]);
  }
  return order;
}

}  // namespace

int TimedRounds(std::uint64_t count) {
  return static_cast<int>(std::clamp<std::uint64_t>(count / 512, 1, kMaxRounds));
}

void RunTimedPass(const SweepPlan& plan, const EnergyRow& energy, std::vector<RowResult>& rows,
                  Progress& progress) {
  const int rounds = TimedRounds(plan.count);
  const auto threads = static_cast<std::size_t>(plan.threads);
  for (int round = 0; round < rounds; ++round) {
    const std::uint64_t first = plan.count * static_cast<std::uint64_t>(round) /
                                static_cast<std::uint64_t>(rounds);
    const std::uint64_t last = plan.count * static_cast<std::uint64_t>(round + 1) /
                               static_cast<std::uint64_t>(rounds);
    const auto blocks = static_cast<std::int64_t>((last - first + kBlock - 1) / kBlock);
    // seconds[t][r]: time of thread t in row r. Configurations are counted likewise, since the last
    // block is filled up to whole tiles.
    std::vector<std::vector<double>> seconds(threads, std::vector<double>(rows.size()));
    std::vector<std::int64_t> configurations(threads);
    bool stopped = false;
#pragma omp parallel num_threads(plan.threads)
    {
      const auto t = static_cast<std::size_t>(omp_get_thread_num());
      // One thread: its processor time. More: wall time, since they share the machine.
      double (*const clock)() = threads == 1 ? ThreadSeconds : WallSeconds;
      Batch batch(energy);
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
        const std::uint64_t begin = first + static_cast<std::uint64_t>(block * kBlock);
        const auto size = std::min<std::int64_t>(kBlock, static_cast<std::int64_t>(last - begin));
        batch.Draw(*plan.distribution, plan.seed, begin, WholeTiles(size));
        for (std::size_t r : Shuffled(rows.size(), plan.seed, begin)) {
          const double start = clock();
          RunInto(*rows[r].row, batch, ring.Data());
          seconds[t][r] += clock() - start;
        }
        configurations[t] += batch.Size();
        progress.Advance(static_cast<std::uint64_t>(size));
      }
    }
    if (stopped) return;
    const auto total = static_cast<double>(
        std::accumulate(configurations.begin(), configurations.end(), std::int64_t{0}));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double slowest = 0;  // the threads run side by side: the last one to finish counts
      for (std::size_t t = 0; t < threads; ++t) slowest = std::max(slowest, seconds[t][r]);
      rows[r].timing.rounds.push_back(slowest / total);
    }
  }
}

}  // namespace definite
