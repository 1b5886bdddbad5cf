#include "benchmarks/harness/sweep.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

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

std::vector<SweepResult> RunSweeps(std::span<const SweepPlan> plans, Progress& progress) {
  std::vector<SweepResult> results;
  std::uint64_t timed = 0, checked = 0;
  for (const SweepPlan& plan : plans) {
    SweepResult& result = results.emplace_back();
    result.plan = plan;
    if (double load; getloadavg(&load, 1) == 1) result.load_before = load;
    for (const KernelRow* row : plan.rows) {
      auto at = std::ranges::find(result.energies, row->energy, &EnergyResult::energy);
      if (at == result.energies.end()) {
        result.energies.push_back({row->energy, {}, {}, 0, 0});
        at = result.energies.end() - 1;
      }
      at->rows.push_back({row, {}, {}, {}});
    }
    const std::uint64_t total = plan.count * result.energies.size();
    checked += total;
    if (plan.timing) timed += total;
  }
  if (timed) progress.Start("timed pass", timed);
  for (SweepResult& result : results) {
    if (!result.plan.timing) continue;
    for (EnergyResult& energy : result.energies) RunTimedPass(result.plan, energy, progress);
  }
  progress.Start("checked pass", checked);
  for (SweepResult& result : results) {
    for (EnergyResult& energy : result.energies) {
      if (!RunCheckedPass(result.plan, energy, progress)) result.partial = true;
    }
  }
  progress.Finish();
  return results;
}

SweepResult RunSweep(const SweepPlan& plan, Progress& progress) {
  return std::move(RunSweeps({&plan, 1}, progress).front());
}

}  // namespace definite
