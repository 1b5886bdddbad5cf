#include "benchmarks/harness/sweep.hpp"

#include <algorithm>
#include <cstdlib>

#include "benchmarks/harness/checked_pass.hpp"
#include "benchmarks/harness/timed_pass.hpp"

namespace definite {

namespace {

void AddIf(Figure& figure, const std::optional<double>& value, std::uint64_t index) {
  if (value) figure.Add(*value, index);
}

}  // namespace

void RowStatistics::Add(const RowFigures& figures, std::uint64_t index) {
  ++verdicts[static_cast<std::size_t>(figures.verdict)];
  AddIf(distance, figures.distance, index);
  AddIf(excess, figures.excess, index);
  AddIf(psd_defect, figures.psd_defect, index);
  AddIf(majorises, figures.majorises, index);
  AddIf(relabelling, figures.relabelling, index);
  if (figures.defined) ++defined;
  AddTruth(figures, index);
}

void RowStatistics::AddTruth(const RowFigures& figures, std::uint64_t index) {
  AddIf(rounding, figures.rounding, index);
  AddIf(conditioned_rounding, figures.conditioned_rounding, index);
  if (figures.flip) {
    ++flip_checks;
    if (*figures.flip) ++flips;
  }
  for (Property property : figures.broken) {
    const auto [at, is_new] = broken.try_emplace(property, index);
    at->second = std::min(at->second, index);
  }
}

void RowStatistics::Merge(const RowStatistics& other) {
  for (auto figure : {&RowStatistics::distance, &RowStatistics::excess, &RowStatistics::psd_defect,
                      &RowStatistics::majorises, &RowStatistics::relabelling,
                      &RowStatistics::rounding, &RowStatistics::conditioned_rounding}) {
    (this->*figure).Merge(other.*figure);
  }
  for (std::size_t v = 0; v < verdicts.size(); ++v) verdicts[v] += other.verdicts[v];
  defined += other.defined;
  flips += other.flips;
  flip_checks += other.flip_checks;
  checksum += other.checksum;
  for (const auto& [property, index] : other.broken) {
    const auto [at, is_new] = broken.try_emplace(property, index);
    at->second = std::min(at->second, index);
  }
}

void EnergyStatistics::Add(const ConfigurationFigures& figures, std::uint64_t index) {
  ++count;
  if (!figures.in_domain) {
    ++out_of_domain;
  } else if (figures.active) {
    ++active;
    if (figures.indefinite) ++indefinite;
  }
  AddIf(value_rounding, figures.value_rounding, index);
  AddIf(gradient_rounding, figures.gradient_rounding, index);
}

void EnergyStatistics::Merge(const EnergyStatistics& other) {
  count += other.count;
  active += other.active;
  indefinite += other.indefinite;
  out_of_domain += other.out_of_domain;
  value_rounding.Merge(other.value_rounding);
  gradient_rounding.Merge(other.gradient_rounding);
}

Depth DepthOf(std::uint64_t index, std::uint64_t count, const Samples& samples) {
  // Every so many configurations, so that there are at most `most`, and at most one in `every`.
  const auto sampled = [&](std::uint64_t most, std::uint64_t every) {
    return most > 0 && index % std::max(every, (count + most - 1) / most) == 0;
  };
  if (sampled(samples.truth, 100)) return Depth::kTruth;
  Depth depth = Depth::kCheap;
  depth.spectrum = sampled(samples.spectrum, 10);
  depth.definition = sampled(samples.definition, 1);
  return depth;
}

bool IsSampled(const KernelRow& row) {
  return row.filter.starts_with("numeric") || row.filter == "absolute_numeric";
}

SweepResult Prepare(const SweepPlan& plan) {
  SweepResult result;
  result.plan = plan;
  if (double load; getloadavg(&load, 1) == 1) result.load_before = load;
  for (const KernelRow* row : plan.rows) {
    auto at = std::ranges::find(result.energies, row->energy, &EnergyResult::energy);
    if (at == result.energies.end()) {
      result.energies.push_back({row->energy, {}, {}, {}, 0, 0});
      at = result.energies.end() - 1;
    }
    at->rows.push_back({row, {}, {}, {}, {}});
  }
  return result;
}

bool IsWhole(const SweepResult& result) {
  const std::size_t all = BlocksOf(result.plan.count, {}).size();
  return std::ranges::all_of(
      result.energies, [all](const EnergyResult& energy) { return energy.blocks.size() == all; });
}

namespace {

std::uint64_t Size(std::span<const Block> blocks) {
  return blocks.empty() ? 0 : blocks.back().end - blocks.front().first;
}

void RunTimedPasses(std::span<SweepResult> results, Progress& progress) {
  std::uint64_t total = 0;
  for (const SweepResult& result : results) {
    if (!result.plan.timing) continue;
    total += Size(BlocksOf(result.plan.count, result.plan.shard)) * result.energies.size();
  }
  if (total) progress.Start("timed pass", total);
  for (SweepResult& result : results) {
    if (!result.plan.timing) continue;
    for (EnergyResult& energy : result.energies) RunTimedPass(result.plan, energy, progress);
  }
}

// The blocks of the plan's shard that are not in the result yet.
std::vector<Block> Missing(const SweepPlan& plan, const EnergyResult& energy) {
  std::vector<Block> blocks = BlocksOf(plan.count, plan.shard);
  std::erase_if(blocks, [&](const Block& block) { return energy.blocks.contains(block.first); });
  return blocks;
}

void RunCheckedPasses(std::span<SweepResult> results, Progress& progress,
                      const RunControl& control) {
  std::uint64_t total = 0;
  for (const SweepResult& result : results) {
    if (!result.plan.checks) continue;
    for (const EnergyResult& energy : result.energies) {
      for (const Block& block : Missing(result.plan, energy)) total += block.Size();
    }
  }
  if (total) progress.Start("checked pass", total);
  for (SweepResult& result : results) {
    if (!result.plan.checks) continue;
    for (EnergyResult& energy : result.energies) {
      const std::vector<Block> missing = Missing(result.plan, energy);
      std::span<const Block> rest = missing;
      while (!rest.empty() && !Interrupted()) {
        const double seconds = control.checkpoint ? control.checkpoint_seconds : 1e300;
        rest = rest.subspan(CheckBlocks(result.plan, rest, seconds, energy, progress));
        if (control.checkpoint) control.checkpoint(result);
      }
      if (!rest.empty()) result.partial = true;
    }
    if (!result.plan.worst_cases) continue;
    for (EnergyResult& energy : result.energies) ExamineWorstCases(result.plan, energy);
  }
}

}  // namespace

std::vector<SweepResult> RunSweeps(std::span<const SweepPlan> plans, Progress& progress) {
  std::vector<SweepResult> results;
  for (const SweepPlan& plan : plans) results.push_back(Prepare(plan));
  RunTimedPasses(results, progress);
  RunCheckedPasses(results, progress, {});
  progress.Finish();
  return results;
}

SweepResult RunSweep(const SweepPlan& plan, Progress& progress, const RunControl& control) {
  SweepResult result = Prepare(plan);
  if (control.earlier) {
    // Of the same plan, so the energies and their rows are in the same order.
    for (std::size_t e = 0; e < result.energies.size(); ++e) {
      EnergyResult& energy = result.energies[e];
      energy.statistics = control.earlier->energies[e].statistics;
      energy.blocks = control.earlier->energies[e].blocks;
      for (std::size_t r = 0; r < energy.rows.size(); ++r) {
        energy.rows[r].statistics = control.earlier->energies[e].rows[r].statistics;
      }
    }
  }
  RunTimedPasses({&result, 1}, progress);
  RunCheckedPasses({&result, 1}, progress, control);
  progress.Finish();
  return result;
}

}  // namespace definite
