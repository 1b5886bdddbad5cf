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

Depth DepthOf(std::uint64_t index, std::uint64_t count) {
  // Every so many configurations, so that there are at most `samples`, and at most one in `every`.
  const auto sampled = [&](std::uint64_t samples, std::uint64_t every) {
    return index % std::max(every, (count + samples - 1) / samples) == 0;
  };
  if (sampled(10'000, 100)) return Depth::kTruth;
  if (sampled(100'000, 10)) return Depth::kSpectral;
  if (sampled(1'000'000, 1)) return Depth::kDefinition;
  return Depth::kCheap;
}

SweepResult RunSweep(const SweepPlan& plan, Progress& progress) {
  SweepResult result;
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
  if (plan.timing) {
    progress.Start("timed pass", total);
    for (EnergyResult& energy : result.energies) RunTimedPass(plan, energy, progress);
  }
  progress.Start("checked pass", total);
  for (EnergyResult& energy : result.energies) {
    if (!RunCheckedPass(plan, energy, progress)) result.partial = true;
  }
  progress.Finish();
  return result;
}

}  // namespace definite
