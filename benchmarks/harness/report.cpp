#include "benchmarks/harness/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"
#include "benchmarks/harness/timed_pass.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity and no NaN: they are written as strings, unknown as null.
Json Number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

bool HasHistograms(Detail detail) {
  return detail == Detail::kWithHistograms || detail == Detail::kCanonical;
}

Json Point(const SweepPlan& plan, const EnergyRow& energy, const Worst& worst,
           const std::optional<double>& exact, Detail detail) {
  Json point = {{"value", Number(worst.value)}, {"index", worst.index}};
  point["exact"] = exact ? Number(*exact) : Json();
  point["x"] = nullptr;
  point["p"] = nullptr;
  if (detail == Detail::kBrief) return point;
  Batch batch(energy, plan.overrides);
  batch.Draw(*plan.distribution, plan.seed, worst.index, kTile);
  for (int i = 0; i < energy.dofs; ++i) point["x"].push_back(HexFloat(batch.X(0)[i]));
  for (std::size_t i = 0; i < energy.parameters.size(); ++i) {
    point["p"].push_back(HexFloat(batch.P(0)[i]));
  }
  return point;
}

// `exact` is what float128 makes of the worst case, where it was asked and differs in principle.
Json ToJson(const Figure& figure, const SweepPlan& plan, const EnergyRow& energy,
            const std::map<std::uint64_t, RowFigures>& worst_cases,
            std::optional<double> RowFigures::*exact, Detail detail) {
  const auto summary = figure.Summarize();
  if (!summary && figure.NanCount() == 0) return nullptr;
  if (!summary) {
    return {{"count", 0},     {"nan", figure.NanCount()}, {"min", nullptr}, {"median", nullptr},
            {"p99", nullptr}, {"p999", nullptr},          {"max", nullptr}, {"histogram", nullptr}};
  }
  std::optional<double> value;
  if (const auto at = worst_cases.find(summary->max.index); exact && at != worst_cases.end()) {
    value = at->second.*exact;
  }
  Json json = {{"count", summary->count},
               {"nan", figure.NanCount()},
               {"min", Number(summary->min)},
               {"median", Number(summary->median)},
               {"p99", Number(summary->p99)},
               {"p999", Number(summary->p999)},
               {"max", Point(plan, energy, summary->max, value, detail)}};
  json["histogram"] = nullptr;
  if (HasHistograms(detail)) {
    json["histogram"] = Json::array();
    for (const Histogram::Bucket& bucket : figure.Values().Buckets()) {
      json["histogram"].push_back({bucket.lower, bucket.count});
    }
  }
  return json;
}

Json ToJson(const std::optional<MedianEstimate>& estimate, double factor) {
  if (!estimate) return nullptr;
  return {{"median", estimate->median * factor},
          {"minimum", estimate->minimum * factor},
          {"low", estimate->low * factor},
          {"high", estimate->high * factor}};
}

// Whom the rows are compared with: scalar rows of these filters.
constexpr std::string_view kBaselines[] = {"numeric", "gauss_newton", "gauss_newton_frame"};

const RowResult* Baseline(const EnergyResult& energy, std::string_view filter) {
  for (const RowResult& r : energy.rows) {
    if (r.row->filter == filter && r.row->scalar == "f64") return &r;
  }
  return nullptr;
}

using Rounds = std::vector<double> RowTiming::*;

// Round by round: baseline / row.
std::optional<MedianEstimate> RatioTo(const RowResult* baseline, const RowResult& row,
                                      Rounds rounds) {
  if (!baseline) return std::nullopt;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < (row.timing.*rounds).size(); ++i) {
    ratios.push_back((baseline->timing.*rounds)[i] / (row.timing.*rounds)[i]);
  }
  return EstimateMedian(ratios);
}

Json TimingToJson(const SweepPlan& plan, const EnergyResult& energy, const RowResult& r,
                  const char* pairs, Rounds rounds, Detail detail) {
  Json timing;
  timing["pairs"] = pairs;
  timing["threads"] = plan.threads;
  timing["clock"] = plan.threads == 1 ? "thread_cpu" : "wall";
  timing["rounds"] = (r.timing.*rounds).size();
  timing["share"] = TimedShare(*r.row);
  timing["output"] = r.row->output;
  timing["ring"] = "L1";
  timing["ring_configurations"] = kRing;
  timing["stages"] = {"frame", "hessian", "filter", "write"};
  timing["ns_per_hessian"] = ToJson(EstimateMedian(r.timing.*rounds), 1e9);
  if (HasHistograms(detail)) {
    for (double seconds : r.timing.*rounds) timing["samples"].push_back(1e9 * seconds);
  }
  for (std::string_view filter : kBaselines) {
    timing["ratio_to"][std::string(filter)] =
        ToJson(RatioTo(Baseline(energy, filter), r, rounds), 1);
  }
  timing["ratio_to"]["floor"] = nullptr;
  return timing;
}

double Fraction(std::uint64_t part, std::uint64_t whole) {
  return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

using Broken = std::map<Property, std::uint64_t>;

// With what float128 found in worst cases.
Broken AllBroken(const RowResult& r) {
  RowStatistics all = r.statistics;
  all.Merge(r.of_worst_cases);
  return all.broken;
}

Json ToJson(const Broken& broken) {
  Json json = Json::array();
  for (const auto& [property, index] : broken) {
    json.push_back({{"property", PropertyName(property)}, {"index", index}});
  }
  return json;
}

// The greatest alone.
Json ToJson(const Figure& figure) {
  const auto summary = figure.Summarize();
  if (!summary) return nullptr;
  return {{"value", Number(summary->max.value)}, {"index", summary->max.index}};
}

Json RowToJson(const SweepResult& result, const EnergyResult& energy, const RowResult& r,
               Detail detail) {
  const SweepPlan& plan = result.plan;
  const EnergyStatistics& e = energy.statistics;
  const RowStatistics& s = r.statistics;
  Json row;
  row["kernel"] = r.row->name;
  row["energy"] = energy.energy->name;
  row["filter"] = r.row->filter;
  row["scalar"] = r.row->scalar;
  row["source"] = fmt::format("{}; {}", energy.energy->source, r.row->source);
  row["distribution"] = plan.distribution->name;
  for (const ParameterValue& p : plan.overrides) {
    if (HasParameter(*energy.energy, p.name)) row["set"][std::string(p.name)] = p.value;
  }
  row["count"] = e.count;
  row["active"] = e.active;
  if (HasHistograms(detail)) {
    row["indefinite"] = e.indefinite;
    row["out_of_domain"] = e.out_of_domain;
  }
  row["active_fraction"] = e.count ? Json(Fraction(e.active, e.count)) : Json();
  row["indefinite_fraction"] = e.active ? Json(Fraction(e.indefinite, e.active)) : Json();
  row["timing"] = Json::array();
  const bool timed = detail != Detail::kCanonical;
  if (timed && !r.timing.all.empty()) {
    row["timing"].push_back(TimingToJson(plan, energy, r, "all", &RowTiming::all, detail));
  }
  if (timed && !r.timing.active.empty()) {
    row["timing"].push_back(TimingToJson(plan, energy, r, "active", &RowTiming::active, detail));
  }
  const auto figure = [&](const Figure& f, std::optional<double> RowFigures::*exact) {
    static const std::map<std::uint64_t, RowFigures> kNone;
    return ToJson(f, plan, *energy.energy, detail == Detail::kCanonical ? kNone : r.worst_cases,
                  exact, detail);
  };
  const auto unless_brief = [&](const Figure& f) {
    return detail == Detail::kBrief ? Json() : figure(f, nullptr);
  };
  row["accuracy"] = {{"distance", figure(s.distance, &RowFigures::distance)},
                     {"excess", figure(s.excess, &RowFigures::excess)},
                     {"rounding", unless_brief(s.rounding)},
                     {"conditioned_rounding", unless_brief(s.conditioned_rounding)},
                     {"psd_defect", figure(s.psd_defect, nullptr)},
                     {"majorises", unless_brief(s.majorises)},
                     {"relabelling", figure(s.relabelling, nullptr)},
                     {"value_rounding", unless_brief(e.value_rounding)},
                     {"gradient_rounding", unless_brief(e.gradient_rounding)},
                     {"flips", s.flips},
                     {"flip_checks", s.flip_checks},
                     {"defined", s.defined}};
  for (std::size_t v = 0; v < s.verdicts.size(); ++v) {
    row["verdicts"][std::string(kVerdictNames[v])] = s.verdicts[v];
  }
  if (detail == Detail::kWithHistograms) {
    const RowStatistics& w = r.of_worst_cases;
    row["worst_cases"] = {{"rounding", ToJson(w.rounding)},
                          {"conditioned_rounding", ToJson(w.conditioned_rounding)},
                          {"broken_promises", ToJson(w.broken)}};
  }
  row["broken_promises"] = ToJson(HasHistograms(detail) ? s.broken : AllBroken(r));
  row["checksum"] = fmt::format("{:016x}", s.checksum);
  return row;
}

Json ToJson(const SweepPlan& plan) {
  Json json = {{"kernels", Json::array()},
               {"distribution", plan.distribution->name},
               {"set", Json::object()},
               {"seed", plan.seed},
               {"count", plan.count},
               {"samples",
                {{"definition", plan.samples.definition},
                 {"spectrum", plan.samples.spectrum},
                 {"truth", plan.samples.truth}}}};
  if (plan.distribution->recorded) json["recorded"] = RecordedToJson(*plan.distribution);
  for (const KernelRow* row : plan.rows) json["kernels"].push_back(row->name);
  for (const ParameterValue& p : plan.overrides) json["set"][std::string(p.name)] = p.value;
  return json;
}

Json BlocksToJson(const SweepResult& result) {
  Json json = Json::object();
  for (const EnergyResult& energy : result.energies) {
    Json& blocks = json[energy.energy->name] = Json::array();
    for (const auto& [first, digest] : energy.blocks) {
      blocks.push_back({first, fmt::format("{:016x}", digest)});
    }
  }
  return json;
}

// More processes wanted to run than there were cores: a twentieth of the timed pass went to others.
bool IsNoisy(const SweepResult& result) {
  return std::ranges::any_of(result.energies, [](const EnergyResult& energy) {
    return energy.timed_cpu < 0.95 * energy.timed_wall;
  });
}

std::string Short(const Figure& figure, double Figure::Summary::*value) {
  const auto summary = figure.Summarize();
  return summary ? fmt::format("{:.1e}", (*summary).*value) : "-";
}

std::string ShortMax(const Figure& figure) {
  const auto summary = figure.Summarize();
  return summary ? fmt::format("{:.1e}", summary->max.value) : "-";
}

// The worst verdict there is, and how often.
std::string VerdictSummary(const RowStatistics& s) {
  std::uint64_t total = 0;
  for (std::uint64_t n : s.verdicts) total += n;
  if (total == 0) return "-";
  for (Verdict v :
       {Verdict::kCrash, Verdict::kNonFinite, Verdict::kInconsistent, Verdict::kSilentZero,
        Verdict::kNonPsd, Verdict::kDegraded, Verdict::kOutOfDomain}) {
    const auto i = static_cast<std::size_t>(v);
    if (s.verdicts[i]) {
      const double percent = 100 * Fraction(s.verdicts[i], total);
      return percent < 1 ? fmt::format("{} <1%", kVerdictNames[i])
                         : fmt::format("{} {:.0f}%", kVerdictNames[i], percent);
    }
  }
  return "pass";
}

}  // namespace

Json RecordedToJson(const Distribution& distribution) {
  if (!distribution.recorded) return nullptr;
  return {{"configurations", distribution.recorded->Size()},
          {"digest", fmt::format("{:016x}", distribution.recorded->digest)}};
}

std::string ForShell(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_./-=", c); };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string quoted;
  for (const char c : word) c == '\'' ? quoted += "'\\''" : quoted += c;
  return fmt::format("'{}'", quoted);
}

std::string HexFloat(double value) { return fmt::format("{:a}", value); }

std::string WithCommas(std::uint64_t value) {
  if (value < 1000) return std::to_string(value);
  return fmt::format("{},{:03}", WithCommas(value / 1000), value % 1000);
}

Json ResultHead(const std::vector<std::string>& command, std::uint64_t seed, bool partial,
                std::optional<double> load_before, bool noisy) {
  return {{"schema", "definite/1"},   {"protocol", ProtocolHash()},
          {"command", command},       {"machine", DescribeMachine(load_before, noisy)},
          {"build", DescribeBuild()}, {"seed", seed},
          {"partial", partial},       {"rows", Json::array()}};
}

Json ToJson(const SweepResult& result, const std::vector<std::string>& command, Detail detail) {
  return ToJson({&result, 1}, command, detail);
}

Json ToJson(std::span<const SweepResult> results, const std::vector<std::string>& command,
            Detail detail) {
  const SweepResult& first = results.front();
  Json json;
  json["schema"] = "definite/1";
  json["protocol"] = ProtocolHash();
  if (detail != Detail::kCanonical) {
    json["command"] = command;
    json["machine"] = DescribeMachine(first.load_before, std::ranges::any_of(results, IsNoisy));
  }
  json["build"] = DescribeBuild();
  json["seed"] = first.plan.seed;
  json["partial"] = detail == Detail::kCanonical
                        ? !std::ranges::all_of(results, IsWhole)
                        : std::ranges::any_of(results, &SweepResult::partial);
  if (HasHistograms(detail)) {
    json["plan"] = ToJson(first.plan);
    json["blocks"] = BlocksToJson(first);
  }
  json["rows"] = Json::array();
  for (const SweepResult& result : results) {
    for (const EnergyResult& energy : result.energies) {
      for (const RowResult& r : energy.rows) {
        json["rows"].push_back(RowToJson(result, energy, r, detail));
      }
    }
  }
  return json;
}

std::string Dump(const Json& json, Detail detail) {
  // A path among the command's words need not be UTF-8.
  constexpr auto kReplace = Json::error_handler_t::replace;
  if (HasHistograms(detail)) return json.dump(-1, ' ', false, kReplace) + "\n";
  if (detail == Detail::kSummaries) return json.dump(1, ' ', false, kReplace) + "\n";
  std::string text = "{";
  for (const auto& [key, value] : json.items()) {
    text += fmt::format("{}\n \"{}\": ", text == "{" ? "" : ",", key);
    if (key != "rows") {
      text += value.dump(-1, ' ', false, kReplace);
      continue;
    }
    std::string rows;
    for (const Json& row : value) {
      rows += fmt::format("{}\n  {}", rows.empty() ? "" : ",", row.dump(-1, ' ', false, kReplace));
    }
    text += "[" + rows + "\n ]";
  }
  return text + "\n}\n";
}

std::string ToTable(const SweepResult& result) {
  std::string table;
  for (const EnergyResult& energy : result.energies) {
    const EnergyStatistics& e = energy.statistics;
    table += fmt::format(
        "{}\n{}{}, seed {}: {} configurations, {:.4g} % active, {:.4g} % of them "
        "indefinite\n\n",
        energy.energy->name, result.plan.distribution->name, Describe(result.plan, *energy.energy),
        result.plan.seed, WithCommas(e.count), 100 * Fraction(e.active, e.count),
        100 * Fraction(e.indefinite, e.active));
    table += fmt::format("{:<19}{:<6}{:>7}{:>8} |{:>24} |{:>8}{:>8} |\n", "", "", "ns per",
                         "numeric", "distance to nearest  ", "rounding", "PSD");
    table += fmt::format("{:<19}{:<6}{:>7}{:>8} |{:>8}{:>8}{:>8} |{:>8}{:>8} | {}\n", "filter", "",
                         "Hessian", "/ this", "median", "p99", "max", "max", "defect", "verdict");
    for (const RowResult& r : energy.rows) {
      const RowStatistics& s = r.statistics;
      Figure conditioned_rounding = s.conditioned_rounding;
      conditioned_rounding.Merge(r.of_worst_cases.conditioned_rounding);
      const auto time = EstimateMedian(r.timing.all);
      const auto ratio = RatioTo(Baseline(energy, "numeric"), r, &RowTiming::all);
      table +=
          fmt::format("{:<19}{:<6}{:>7}{:>8} |{:>8}{:>8}{:>8} |{:>8}{:>8} | {}\n", r.row->filter,
                      r.row->scalar, time ? fmt::format("{:.1f}", time->median * 1e9) : "-",
                      ratio ? fmt::format("{:.1f}", ratio->median) : "-",
                      Short(s.distance, &Figure::Summary::median),
                      Short(s.distance, &Figure::Summary::p99), ShortMax(s.distance),
                      ShortMax(conditioned_rounding), ShortMax(s.psd_defect), VerdictSummary(s));
    }
    table += "\n";
  }
  return table;
}

std::string ReplayCommand(const SweepPlan& plan, const KernelRow& row, std::uint64_t index) {
  std::string command =
      fmt::format("definite replay --kernel {} --distribution {} --seed {} --index {}", row.name,
                  ForShell(plan.distribution->name), plan.seed, index);
  for (const ParameterValue& p : plan.overrides) {
    if (HasParameter(*row.energy, p.name)) command += fmt::format(" --set {}={}", p.name, p.value);
  }
  return command;
}

std::string Describe(const SweepPlan& plan, const EnergyRow& energy) {
  std::string text;
  for (const ParameterValue& p : plan.overrides) {
    if (HasParameter(energy, p.name)) text += fmt::format(", {} = {}", p.name, p.value);
  }
  return text;
}

std::string BrokenPromises(const SweepResult& result) {
  std::string lines;
  for (const EnergyResult& energy : result.energies) {
    for (const RowResult& r : energy.rows) {
      for (const auto& [property, index] : AllBroken(r)) {
        lines += fmt::format("{} promises to be {} and is not:\n  {}\n", r.row->name,
                             PropertyName(property), ReplayCommand(result.plan, *r.row, index));
      }
    }
  }
  return lines;
}

}  // namespace definite
