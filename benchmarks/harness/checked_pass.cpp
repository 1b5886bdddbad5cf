#include "benchmarks/harness/checked_pass.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {

namespace {

constexpr std::int64_t kChunk = 256;  // configurations whose outputs are held at a time

// Outputs of one row for a chunk, in both layouts. Kept from chunk to chunk: fresh memory for
// each cost an eighth of the pass.
class RowOutputs {
 public:
  explicit RowOutputs(const KernelRow& row) : row_(&row) {}

  void Run(const Batch& batch) {
    const auto size = static_cast<std::size_t>(batch.Size() * row_->outputs);
    scalar_.Resize(size);
    tiles_.Resize(size);
    if (row_->lanes == 1) {
      row_->run(batch.X(0), batch.P(0), scalar_.Data(), batch.Size());
      ToTiles(scalar_.Data(), row_->outputs, batch.Size(), tiles_.Data());
    } else {
      row_->run(batch.TilesX(row_->lanes, 0), batch.TilesP(row_->lanes, 0), tiles_.Data(),
                batch.Size() / row_->lanes);
      FromTiles(tiles_.Data(), row_->outputs, batch.Size(), scalar_.Data());
    }
  }

  // Runs only on some of the batch; the outputs of the others are zero.
  void RunSome(const Batch& batch, std::span<const std::int64_t> indices, Batch& some) {
    const auto each = static_cast<std::size_t>(row_->outputs);
    const auto size = static_cast<std::size_t>(batch.Size()) * each;
    scalar_.Resize(size);
    tiles_.Resize(size);
    std::fill_n(scalar_.Data(), size, 0.0);
    if (!indices.empty()) {
      some.Take(batch, indices);
      RowOutputs outputs(*row_);
      outputs.Run(some);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        std::ranges::copy(outputs.Of(static_cast<std::int64_t>(i)),
                          scalar_.Data() + static_cast<std::size_t>(indices[i]) * each);
      }
    }
    ToTiles(scalar_.Data(), row_->outputs, batch.Size(), tiles_.Data());
  }

  Packed Of(std::int64_t i) const {
    return {scalar_.Data() + i * row_->outputs, static_cast<std::size_t>(row_->outputs)};
  }
  const double* TileOf(std::int64_t i) const { return tiles_.Data() + i * row_->outputs; }
  std::size_t TileSize() const { return static_cast<std::size_t>(row_->outputs * kTile); }

 private:
  const KernelRow* row_;
  AlignedDoubles scalar_, tiles_;
};

// A number that changes with any bit of any entry; sums of them do not depend on the order. All
// NaNs count alike, since compilers differ in their sign.
std::uint64_t Checksum(Packed f, std::uint64_t index) {
  std::uint64_t sum = 0, weight = 0x9e3779b97f4a7c15;
  for (double a : f) {
    const double canonical = std::isnan(a) ? std::numeric_limits<double>::quiet_NaN() : a;
    sum += (std::bit_cast<std::uint64_t>(canonical) ^ (sum >> 29)) * weight;
    weight += 0x9e3779b97f4a7c16;
  }
  return (sum ^ (sum >> 32)) * (2 * index + 1);
}

struct Statistics {
  EnergyStatistics energy;
  std::vector<RowStatistics> rows;
  std::vector<std::uint64_t> checksums;  // of the rows at one configuration
};

// Sums, so that the digest of a block is a difference.
std::uint64_t Digest(const Statistics& statistics) {
  std::uint64_t digest = 0, weight = 1;
  for (const RowStatistics& row : statistics.rows) digest += (weight += 2) * row.checksum;
  return digest;
}

void Add(const Examiner& examiner, std::span<const RowOutput> outputs, std::uint64_t index,
         Statistics& statistics) {
  statistics.energy.Add(examiner.Configuration(), index);
  const ConfigurationFigures& configuration = examiner.Configuration();
  std::vector<std::uint64_t>& checksums = statistics.checksums;
  checksums.resize(outputs.size());
  for (std::size_t r = 0; r < outputs.size(); ++r) {
    if (!outputs[r].asked) continue;
    const std::size_t twin = outputs[r].twin;
    checksums[r] = twin < r ? checksums[twin] : Checksum(outputs[r].f, index);
    statistics.rows[r].checksum += checksums[r];
    if (configuration.active || !configuration.in_domain) {
      statistics.rows[r].Add(examiner.Row(r), index);
    }
  }
}

// The worst case of each figure of each row.
std::set<std::uint64_t> WorstCases(const EnergyResult& result) {
  std::set<std::uint64_t> indices;
  for (const RowResult& r : result.rows) {
    const RowStatistics& s = r.statistics;
    for (const Figure* figure :
         {&s.distance, &s.excess, &s.psd_defect, &s.majorises, &s.relabelling}) {
      if (const auto summary = figure->Summarize()) indices.insert(summary->max.index);
    }
  }
  return indices;
}

// Runs rows over chunks of configurations, and judges what they made. One for each thread.
class ChunkCheck {
 public:
  ChunkCheck(const SweepPlan& plan, const EnergyRow& energy, std::span<const KernelRow* const> rows)
      : plan_(plan),
        examiner_(energy, rows),
        batch_(energy, plan.overrides),
        some_(energy),
        dofs_(energy.dofs),
        rows_(rows.begin(), rows.end()) {
    // H and P may be among the rows asked for: each runs once.
    for (const KernelRow* row : rows) outputs_.try_emplace(row, *row);
    for (const KernelRow* row : {&examiner_.ExactRow(), &examiner_.NearestRow()}) {
      outputs_.try_emplace(row, *row);
    }
  }

  void Run(std::uint64_t first, std::int64_t size, Statistics& statistics) {
    batch_.Draw(*plan_.distribution, plan_.seed, first, WholeTiles(size));
    sampled_.clear();
    for (std::int64_t i = 0; i < size; ++i) {
      if (DepthAt(first, i).definition) sampled_.push_back(i);
    }
    for (auto& [row, outputs] : outputs_) {
      const bool all =
          !IsSampled(*row) || std::ssize(sampled_) == size || row == &examiner_.NearestRow();
      all ? outputs.Run(batch_) : outputs.RunSome(batch_, sampled_, some_);
    }
    for (std::int64_t i = 0; i < size; i += kTile) {
      MeasureRows(i);
      for (std::int64_t lane = 0; lane < std::min<std::int64_t>(kTile, size - i); ++lane) {
        Judge(first, i + lane, statistics);
      }
    }
  }

 private:
  Depth DepthAt(std::uint64_t first, std::int64_t i) const {
    return DepthOf(first + static_cast<std::uint64_t>(i), plan_.count, plan_.samples);
  }

  // The tile that begins at configuration i.
  void MeasureRows(std::int64_t i) {
    const RowOutputs &exact = outputs_.at(&examiner_.ExactRow()),
                     &nearest = outputs_.at(&examiner_.NearestRow());
    const auto measure = [&](const RowOutputs& outputs, std::span<Measures, kTile> measures) {
      MeasureTile(dofs_, outputs.TileOf(i), nearest.TileOf(i), exact.TileOf(i), measures);
    };
    measure(exact, of_exact_);
    measure(nearest, of_nearest_);
    measured_.resize(rows_.size());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const RowOutputs& mine = outputs_.at(rows_[r]);
      std::size_t twin = 0;
      while (twin < r && (rows_[twin]->filter != rows_[r]->filter ||
                          std::memcmp(outputs_.at(rows_[twin]).TileOf(i), mine.TileOf(i),
                                      mine.TileSize() * sizeof(double)) != 0)) {
        ++twin;
      }
      measured_[r].twin = twin;
      if (twin == r) measure(mine, measured_[r].measures);
    }
  }

  void Judge(std::uint64_t first, std::int64_t i, Statistics& statistics) {
    const auto lane = static_cast<std::size_t>(i % kTile);
    const Depth depth = DepthAt(first, i);
    const ExactOutput exact = {outputs_.at(&examiner_.ExactRow()).Of(i),
                               outputs_.at(&examiner_.NearestRow()).Of(i), of_exact_[lane],
                               of_nearest_[lane].norm};
    asked_.clear();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      asked_.push_back({outputs_.at(rows_[r]).Of(i), measured_[r].measures[lane], measured_[r].twin,
                        depth.definition || !IsSampled(*rows_[r])});
    }
    examiner_.Examine(batch_.X(i), batch_.P(i), exact, asked_, depth);
    Add(examiner_, asked_, first + static_cast<std::uint64_t>(i), statistics);
  }

  using TileMeasures = std::array<Measures, kTile>;
  struct MeasuredRow {
    TileMeasures measures;
    std::size_t twin;
  };

  const SweepPlan& plan_;
  Examiner examiner_;
  Batch batch_, some_;
  int dofs_;
  std::vector<const KernelRow*> rows_;
  std::map<const KernelRow*, RowOutputs> outputs_;
  std::vector<std::int64_t> sampled_;  // configurations of the chunk that all rows run on
  TileMeasures of_exact_, of_nearest_;
  std::vector<MeasuredRow> measured_;
  std::vector<RowOutput> asked_;
};

}  // namespace

std::size_t CheckBlocks(const SweepPlan& plan, std::span<const Block> blocks, double seconds,
                        EnergyResult& result, Progress& progress) {
  std::vector<const KernelRow*> rows;
  for (const RowResult& r : result.rows) rows.push_back(r.row);
  const double start = WallSeconds();
  std::atomic<std::size_t> next_block{0};
  std::vector<Statistics> parts(static_cast<std::size_t>(plan.threads));
  std::vector<std::uint64_t> digests(blocks.size());
#pragma omp parallel num_threads(plan.threads)
  {
    Statistics& mine = parts[static_cast<std::size_t>(omp_get_thread_num())];
    mine.rows.resize(rows.size());
    ChunkCheck check(plan, *result.energy, rows);
    // Blocks are handed out in order and always finished, so that those done are the first ones.
    while (!Interrupted() && WallSeconds() - start < seconds) {
      const std::size_t b = next_block++;
      if (b >= blocks.size()) break;
      const std::uint64_t before = Digest(mine);
      for (std::uint64_t first = blocks[b].first; first < blocks[b].end; first += kChunk) {
        const auto size =
            std::min<std::int64_t>(kChunk, static_cast<std::int64_t>(blocks[b].end - first));
        check.Run(first, size, mine);
        progress.Advance(static_cast<std::uint64_t>(size));
      }
      digests[b] = Digest(mine) - before;
    }
  }
  for (const Statistics& part : parts) {
    result.statistics.Merge(part.energy);
    for (std::size_t r = 0; r < part.rows.size(); ++r) {
      result.rows[r].statistics.Merge(part.rows[r]);
    }
  }
  const std::size_t done = std::min(next_block.load(), blocks.size());
  for (std::size_t b = 0; b < done; ++b) result.blocks[blocks[b].first] = digests[b];
  return done;
}

void ExamineWorstCases(const SweepPlan& plan, EnergyResult& result) {
  std::vector<const KernelRow*> rows;
  for (const RowResult& r : result.rows) rows.push_back(r.row);
  Examiner examiner(*result.energy, rows);
  Batch batch(*result.energy, plan.overrides);
  for (std::uint64_t index : WorstCases(result)) {
    batch.Draw(*plan.distribution, plan.seed, index, kTile);
    examiner.Examine(batch.X(0), batch.P(0), Depth::kTruth);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      result.rows[r].worst_cases[index] = examiner.Row(r);
      if (!DepthOf(index, plan.count, plan.samples).truth) {
        result.rows[r].of_worst_cases.AddTruth(examiner.Row(r), index);
      }
    }
  }
}

}  // namespace definite
