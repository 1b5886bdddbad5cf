#include "benchmarks/advice/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"
#include "benchmarks/plans/markdown.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFilters[] = {"gauss_newton", "analytic", "split",  "nearest",
                                         "blend_half",   "absolute", "numeric"};

// Nanoseconds for an active configuration.
double CostOf(const RowResult& row) {
  const auto time = EstimateMedian(row.timing.active);
  return time ? 1e9 * time->median : std::numeric_limits<double>::infinity();
}

double P99(const RowResult& row) {
  const auto distance = row.statistics.distance.Summarize();
  return distance ? distance->p99 : std::numeric_limits<double>::infinity();
}

std::string NameOf(const RowResult& row) {
  return fmt::format("{}/{}", row.row->filter, row.row->scalar);
}

std::vector<DegeneracyCount> CountDegeneracies(const SweepPlan& plan, const EnergyRow& energy) {
  constexpr std::uint64_t kChunk = 4096;
  std::vector<DegeneracyCount> all = DegeneraciesOf(energy.stencil);
  const auto chunks = static_cast<std::int64_t>(CeilDivide(plan.count, kChunk));
#pragma omp parallel num_threads(plan.threads)
  {
    std::vector<DegeneracyCount> mine = DegeneraciesOf(energy.stencil);
    Batch batch(energy, plan.overrides);
#pragma omp for schedule(dynamic)
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
      const std::uint64_t first = kChunk * static_cast<std::uint64_t>(chunk);
      const auto size = static_cast<std::int64_t>(std::min(kChunk, plan.count - first));
      batch.Draw(*plan.distribution, plan.seed, first, WholeTiles(size));
      for (std::int64_t i = 0; i < size; ++i) {
        double classification[3];
        energy.classify(batch.X(i), batch.P(i), classification, 1);
        const auto [active, in_domain, region] = classification;
        if (active != 1 && in_domain == 1) continue;
        for (DegeneracyCount& count : mine) {
          count.Add(count.family->delta(energy.stencil, batch.X(i)),
                    first + static_cast<std::uint64_t>(i));
        }
      }
    }
#pragma omp critical
    for (std::size_t f = 0; f < all.size(); ++f) all[f].Merge(mine[f]);
  }
  return all;
}

std::uint64_t LineOf(const SweepPlan& plan, std::uint64_t index) {
  const std::vector<std::uint32_t>& lines = plan.distribution->recorded->lines;
  return lines[index % lines.size()];
}

std::string Percent(std::uint64_t part, std::uint64_t whole) {
  return whole
             ? fmt::format("{:.3g} %", 100 * static_cast<double>(part) / static_cast<double>(whole))
             : "-";
}

}  // namespace

std::vector<const KernelRow*> Candidates(const EnergyRow& energy) {
  std::vector<const KernelRow*> rows;
  for (const std::string_view filter : kFilters) {
    const KernelRow* row = FindKernel(fmt::format("{}/{}/f64x8", energy.name, filter));
    if (!row) row = FindKernel(fmt::format("{}/{}/f64", energy.name, filter));
    if (row) rows.push_back(row);
  }
  return rows;
}

SweepResult RunForAdvice(const SweepPlan& plan, Progress& progress) {
  constexpr std::uint64_t kLeastTimed = 50'000;
  SweepPlan plans[] = {plan, plan};
  auto& [timed, checked] = plans;
  timed.count = std::max(plan.count, kLeastTimed);
  timed.checks = false;
  checked.timing = false;
  std::vector<SweepResult> results = RunSweeps(plans, progress);
  SweepResult& result = results[1];
  for (std::size_t r = 0; r < plan.rows.size(); ++r) {
    result.energies.front().rows[r].timing = results[0].energies.front().rows[r].timing;
  }
  result.energies.front().timed_cpu = results[0].energies.front().timed_cpu;
  result.energies.front().timed_wall = results[0].energies.front().timed_wall;
  return result;
}

std::string Objection(const RowResult& row, double tolerance) {
  for (const Verdict verdict : {Verdict::kNonFinite, Verdict::kInconsistent, Verdict::kSilentZero,
                                Verdict::kNonPsd, Verdict::kCrash}) {
    const auto v = static_cast<std::size_t>(verdict);
    if (const std::uint64_t count = row.statistics.verdicts[v]) {
      return fmt::format("is {} in {}", kVerdictNames[v], WithCommas(count));
    }
  }
  if (P99(row) > tolerance) return fmt::format("is {:.2g} away", P99(row));
  return "";
}

Advice AdviseOn(const SweepResult& result, double tolerance) {
  const EnergyResult& energy = result.energies.front();
  Advice advice = {tolerance, nullptr, "", CountDegeneracies(result.plan, *energy.energy)};
  if (energy.statistics.active == 0) {
    advice.reason = "None of the configurations is active: no filter has anything to do.";
    return advice;
  }
  std::vector<const RowResult*> rows;
  for (const RowResult& row : energy.rows) rows.push_back(&row);
  std::ranges::sort(rows, {}, [](const RowResult* row) { return CostOf(*row); });
  const auto chosen = std::ranges::find_if(
      rows, [&](const RowResult* row) { return Objection(*row, tolerance).empty(); });
  std::string objections;  // to those that are cheaper
  for (auto row = rows.begin(); row != chosen; ++row) {
    objections += fmt::format("{}{} ({:.3g} ns) {}", objections.empty() ? "" : ", ", NameOf(**row),
                              CostOf(**row), Objection(**row, tolerance));
  }
  if (chosen == rows.end()) {
    advice.reason = fmt::format("No filter will do: {}.", objections);
    return advice;
  }
  advice.chosen = *chosen;
  advice.reason = fmt::format(
      "{} ({:.3g} ns) is the cheapest that is PSD in every configuration and within {:g} of the "
      "nearest PSD matrix in 99 of 100 active ones ({:.2g}){}{}.",
      NameOf(**chosen), CostOf(**chosen), tolerance, P99(**chosen),
      objections.empty() ? "; none is cheaper" : "; of the cheaper ones ", objections);
  return advice;
}

Json ToJson(const Advice& advice, const SweepResult& result) {
  const EnergyResult& energy = result.energies.front();
  Json json = {{"tolerance", advice.tolerance}, {"chosen", nullptr},
               {"reason", advice.reason},       {"degenerate_below", kDegenerate},
               {"degeneracies", Json::array()}, {"objections", Json::object()}};
  if (advice.chosen) json["chosen"] = advice.chosen->row->name;
  for (const DegeneracyCount& count : advice.degeneracies) {
    json["degeneracies"].push_back({{"family", count.family->name},
                                    {"count", count.count},
                                    {"smallest", count.smallest},
                                    {"line", nullptr}});
    if (count.index) json["degeneracies"].back()["line"] = LineOf(result.plan, *count.index);
  }
  for (const RowResult& row : energy.rows) {
    const std::string objection = Objection(row, advice.tolerance);
    if (!objection.empty()) json["objections"][row.row->name] = objection;
  }
  return json;
}

std::string ToTable(const Advice& advice, const SweepResult& result) {
  const EnergyResult& energy = result.energies.front();
  const EnergyStatistics& e = energy.statistics;
  const SweepPlan& plan = result.plan;
  std::string table = fmt::format(
      "{}{}\n{}: {} configuration{}\n\n  {:<24}{:>12}  {}\n  {:<24}{:>12}  {} of the active\n  "
      "{:<24}{:>12}  {}\n",
      energy.energy->name, Describe(plan, *energy.energy), plan.distribution->name,
      WithCommas(e.count), e.count == 1 ? "" : "s", "active", WithCommas(e.active),
      Percent(e.active, e.count), "indefinite", WithCommas(e.indefinite),
      Percent(e.indefinite, e.active), "outside the domain", WithCommas(e.out_of_domain),
      Percent(e.out_of_domain, e.count));
  if (!advice.degeneracies.empty()) {
    table += fmt::format("\n  degenerate, which is below {:g}, of the active and those outside:\n",
                         kDegenerate);
  }
  for (const DegeneracyCount& count : advice.degeneracies) {
    table += fmt::format("    {:<22}{:>12}  {}", count.family->name, WithCommas(count.count),
                         count.family->meaning);
    if (count.index) {
      table += fmt::format(", {:.1e} in line {}", count.smallest, LineOf(plan, *count.index));
    }
    table += "\n";
  }
  table += fmt::format("\n{:<20}{:>8} |{:>24} |{:>8}{:>8}{:>10} |\n", "", "ns per",
                       "distance to nearest  ", "excess", "PSD", "farthest");
  table += fmt::format("{:<20}{:>8} |{:>8}{:>8}{:>8} |{:>8}{:>8}{:>10} | {}\n", "filter", "active",
                       "median", "p99", "max", "max", "defect", "in line", "objection");
  for (const RowResult& row : energy.rows) {
    const auto distance = row.statistics.distance.Summarize();
    const auto greatest = [](const Figure& figure) {
      const auto summary = figure.Summarize();
      return summary ? fmt::format("{:.1e}", summary->max.value) : "-";
    };
    std::string objection = Objection(row, advice.tolerance);
    objection.resize(std::min(objection.size(), objection.find(" in ")));  // how often: in the JSON
    table += fmt::format("{:<20}{:>8} |{:>8}{:>8}{:>8} |{:>8}{:>8}{:>10} | {}\n", NameOf(row),
                         row.timing.active.empty() ? "-" : fmt::format("{:.1f}", CostOf(row)),
                         distance ? fmt::format("{:.1e}", distance->median) : "-",
                         distance ? fmt::format("{:.1e}", distance->p99) : "-",
                         distance ? fmt::format("{:.1e}", distance->max.value) : "-",
                         greatest(row.statistics.excess), greatest(row.statistics.psd_defect),
                         distance ? fmt::format("{}", LineOf(plan, distance->max.index)) : "-",
                         &row == advice.chosen ? "taken"
                         : objection.empty()   ? "dearer"
                                               : objection);
  }
  return table + "\n" + Wrapped(advice.reason, 98, "") + "\n";
}

}  // namespace definite
