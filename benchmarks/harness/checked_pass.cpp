#include "benchmarks/harness/checked_pass.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "benchmarks/harness/batch.hpp"

namespace definite {

namespace {

constexpr std::int64_t kBlock = 256;

// Outputs of one row for a batch, in scalar layout. Kept from batch to batch: fresh memory for each
// cost an eighth of the pass.
class RowOutputs {
 public:
  explicit RowOutputs(const KernelRow& row) : row_(&row) {}

  void Run(const Batch& batch) {
    const auto size = static_cast<std::size_t>(batch.Size() * row_->outputs);
    scalar_.Resize(size);
    if (row_->lanes == 1) {
      row_->run(batch.X(0), batch.P(0), scalar_.Data(), batch.Size());
    } else {
      tiles_.Resize(size);
      row_->run(batch.TilesX(row_->lanes, 0), batch.TilesP(row_->lanes, 0), tiles_.Data(),
                batch.Size() / row_->lanes);
      FromTiles(tiles_.Data(), row_->outputs, batch.Size(), scalar_.Data());
    }
  }

  Packed Of(std::int64_t i) const {
    return {scalar_.Data() + i * row_->outputs, static_cast<std::size_t>(row_->outputs)};
  }

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
};

void Add(const Examiner& examiner, std::uint64_t index, Statistics& statistics) {
  statistics.energy.Add(examiner.Configuration(), index);
  const ConfigurationFigures& configuration = examiner.Configuration();
  if (configuration.in_domain && !configuration.active) return;
  for (std::size_t r = 0; r < statistics.rows.size(); ++r) {
    statistics.rows[r].Add(examiner.Row(r), index);
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

}  // namespace

bool RunCheckedPass(const SweepPlan& plan, EnergyResult& result, Progress& progress) {
  std::vector<const KernelRow*> rows;
  for (const RowResult& r : result.rows) rows.push_back(r.row);
  const auto blocks =
      static_cast<std::int64_t>((plan.count + kBlock - 1) / static_cast<std::uint64_t>(kBlock));

  std::atomic<std::int64_t> next_block{0};
  std::vector<Statistics> parts(static_cast<std::size_t>(plan.threads));
#pragma omp parallel num_threads(plan.threads)
  {
    Statistics& mine = parts[static_cast<std::size_t>(omp_get_thread_num())];
    mine.rows.resize(rows.size());
    Examiner examiner(*result.energy, rows);
    Batch batch(*result.energy, plan.overrides);
    // H and P may be among the rows asked for: each runs once.
    std::vector<const KernelRow*> all = rows;
    all.push_back(&examiner.ExactRow());
    all.push_back(&examiner.NearestRow());
    std::map<const KernelRow*, RowOutputs> outputs;
    for (const KernelRow* row : all) outputs.try_emplace(row, *row);
    const RowOutputs &exact = outputs.at(&examiner.ExactRow()),
                     &nearest = outputs.at(&examiner.NearestRow());
    std::vector<const RowOutputs*> asked;
    for (const KernelRow* row : rows) asked.push_back(&outputs.at(row));
    std::vector<Packed> of_rows(rows.size());
    // Blocks are handed out in order and always finished, so that an interrupted pass covers a
    // prefix.
    while (!Interrupted()) {
      const std::int64_t block = next_block++;
      if (block >= blocks) break;
      const auto first = static_cast<std::uint64_t>(block * kBlock);
      const auto size =
          std::min<std::int64_t>(kBlock, static_cast<std::int64_t>(plan.count - first));
      batch.Draw(*plan.distribution, plan.seed, first, WholeTiles(size));
      for (auto& [row, output] : outputs) output.Run(batch);
      for (std::int64_t i = 0; i < size; ++i) {
        const std::uint64_t index = first + static_cast<std::uint64_t>(i);
        for (std::size_t r = 0; r < rows.size(); ++r) {
          of_rows[r] = asked[r]->Of(i);
          mine.rows[r].checksum += Checksum(of_rows[r], index);
        }
        examiner.Examine(batch.X(i), batch.P(i), exact.Of(i), nearest.Of(i), of_rows,
                         DepthOf(index, plan.count, plan.samples));
        Add(examiner, index, mine);
      }
      progress.Advance(static_cast<std::uint64_t>(size));
    }
  }
  for (const Statistics& part : parts) {
    result.statistics.Merge(part.energy);
    for (std::size_t r = 0; r < part.rows.size(); ++r) {
      result.rows[r].statistics.Merge(part.rows[r]);
    }
  }

  Examiner examiner(*result.energy, rows);
  Batch batch(*result.energy, plan.overrides);
  for (std::uint64_t index : WorstCases(result)) {
    batch.Draw(*plan.distribution, plan.seed, index, kTile);
    examiner.Examine(batch.X(0), batch.P(0), Depth::kTruth);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      result.rows[r].worst_cases[index] = examiner.Row(r);
      if (!DepthOf(index, plan.count, plan.samples).truth) {
        result.rows[r].statistics.AddTruth(examiner.Row(r), index);
      }
    }
  }
  return !Interrupted();
}

}  // namespace definite
