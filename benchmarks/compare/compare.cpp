#include "benchmarks/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "benchmarks/compare/significance.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

std::string RowKey(const Json& row) {
  std::string key = fmt::format("{}, {}", row.at("kernel").get<std::string>(),
                                row.at("distribution").get<std::string>());
  if (row.contains("set")) {
    for (const auto& [name, value] : row.at("set").items()) {
      key += fmt::format(", {} = {}", name, value.dump());
    }
  }
  return key;
}

std::string Threads(const Json& timing) {
  const int threads = timing.at("threads");
  return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

void AddTimes(const std::string& key, const Json& timing, std::vector<Timed>& times) {
  if (!timing.contains("samples") || timing.at("samples").empty()) return;
  times.push_back({key, timing.at("samples").get<std::vector<double>>()});
}

double Median(const std::vector<double>& values) { return EstimateMedian(values)->median; }

// Names of those that only one side has.
template <class A, class B>
std::vector<std::string> Only(const std::map<std::string, A>& mine,
                              const std::map<std::string, B>& theirs) {
  std::vector<std::string> names;
  for (const auto& [name, value] : mine) {
    if (!theirs.contains(name)) names.push_back(name);
  }
  return names;
}

std::map<std::string, const std::vector<double>*> ByKey(const std::vector<Timed>& times) {
  std::map<std::string, const std::vector<double>*> map;
  for (const Timed& timed : times) map[timed.key] = &timed.ns;
  return map;
}

std::vector<double> LogRatios(const std::vector<double>& now, const std::vector<double>& base) {
  std::vector<double> logs;
  for (std::size_t i = 0; i < std::min(now.size(), base.size()); ++i) {
    logs.push_back(std::log(now[i] / base[i]));
  }
  return logs;
}

// The size that 95 % of the differences between equals stay below.
double Percentile95(std::vector<double> sizes) {
  if (sizes.empty()) return 0;
  std::ranges::sort(sizes);
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(sizes.size())));
  return std::expm1(sizes[rank - 1]);
}

// Without an A/A run: how far apart the rounds of even and of odd number put one ratio.
double BetweenHalves(const std::vector<double>& logs) {
  std::vector<double> halves[2];
  for (std::size_t i = 0; i < logs.size(); ++i) halves[i % 2].push_back(logs[i]);
  if (halves[1].empty()) return 0;
  return std::abs(Median(halves[0]) - Median(halves[1]));
}

}  // namespace

std::vector<Timed> TimesOf(const Json& result) {
  std::vector<Timed> times;
  for (const Json& row : result.at("rows")) {
    for (const Json& timing : row.at("timing")) {
      AddTimes(fmt::format("{}, {} pairs, {}", RowKey(row), timing.at("pairs").get<std::string>(),
                           Threads(timing)),
               timing, times);
    }
  }
  if (result.contains("speed")) {
    const Json& speed = result.at("speed");
    for (const Json& row : speed.at("rows")) {
      AddTimes(fmt::format("{}, {}, {}, {}", row.at("kernel").get<std::string>(),
                           speed.at("distribution").get<std::string>(),
                           row.at("ring").get<std::string>(), Threads(row)),
               row, times);
    }
  }
  if (times.empty()) {
    throw CompareError(
        "it has no times by the round; expected a result of 'definite sweep' or 'definite speed'");
  }
  return times;
}

std::string Differences(const Json& base, const Json& now) {
  std::string text;
  const auto compare = [&](const char* what, const Json& a, const Json& b) {
    if (a != b) text += fmt::format("\n  {}: {} and {}", what, a.dump(), b.dump());
  };
  const auto at = [](const Json& json, const char* object, const char* key) {
    return json.contains(object) && json.at(object).contains(key) ? json.at(object).at(key)
                                                                  : Json();
  };
  compare("protocol", base.at("protocol"), now.at("protocol"));
  for (const char* key : {"cpu", "cores"}) {
    compare(key, at(base, "machine", key), at(now, "machine", key));
  }
  for (const char* key : {"compiler", "flags", "type", "isa", "eigen", "libm"}) {
    compare(key, at(base, "build", key), at(now, "build", key));
  }
  compare("seed", base.at("seed"), now.at("seed"));
  for (const char* key : {"distribution", "set", "count"}) {
    compare(key, at(base, "plan", key), at(now, "plan", key));
  }
  return text;
}

bool Comparison::Regressed() const {
  return std::ranges::any_of(rows,
                             [](const Compared& row) { return row.verdict == Compared::kSlower; });
}

Comparison Compare(const std::vector<Timed>& base, const std::vector<Timed>& now,
                   const std::optional<std::vector<Timed>>& again, const Limits& limits) {
  const auto of_base = ByKey(base), of_new = ByKey(now);
  Comparison comparison;
  comparison.limits = limits;
  comparison.only_base = Only(of_base, of_new);
  comparison.only_new = Only(of_new, of_base);
  std::vector<double> p, noise;
  for (const Timed& timed : base) {
    const auto other = of_new.find(timed.key);
    if (other == of_new.end()) continue;
    const std::vector<double> logs = LogRatios(*other->second, timed.ns);
    std::vector<double> ratios;
    for (double log : logs) ratios.push_back(std::exp(log));
    const auto ratio = EstimateMedian(ratios);
    if (!ratio) continue;
    p.push_back(SignedRankP(logs));
    noise.push_back(BetweenHalves(logs));
    comparison.rows.push_back(
        {timed.key, Median(timed.ns), Median(*other->second), *ratio, 1, Compared::kSame});
  }
  if (comparison.rows.empty()) throw CompareError("the two have no row in common");
  if (again) {
    comparison.floor_from_aa = true;
    noise.clear();
    const auto of_again = ByKey(*again);
    for (const Timed& timed : base) {
      const auto other = of_again.find(timed.key);
      if (other == of_again.end()) continue;
      noise.push_back(std::abs(Median(LogRatios(*other->second, timed.ns))));
    }
  }
  comparison.floor = Percentile95(noise);
  const double beyond = 1 + std::max(comparison.floor, limits.threshold);
  const std::vector<double> adjusted = AdjustForMany(p);
  for (std::size_t r = 0; r < comparison.rows.size(); ++r) {
    Compared& row = comparison.rows[r];
    row.p = adjusted[r];
    if (row.p >= limits.q) continue;
    if (row.ratio.median > beyond) row.verdict = Compared::kSlower;
    if (row.ratio.median < 1 / beyond) row.verdict = Compared::kFaster;
  }
  return comparison;
}

namespace {

// A figure that may be missing or infinite: the greater, the worse. NaNs are counted apart, as a
// verdict.
double Size(const Json& value) {
  if (value.is_null()) return 0;
  return value.is_string() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

// Whether a figure is greater by more than rounding does. Relative distances are good to about
// 1e-12; test ratios, which count roundings, only to a factor.
bool Exceeds(double now, double base, bool test_ratio) {
  return test_ratio ? now > std::max(2 * base, 4.0) : now > base * (1 + 1e-6) + 1e-12;
}

struct FigureRule {
  const char *figure, *entry;
  bool test_ratio;
};
constexpr FigureRule kRules[] = {
    {"distance", "median", false},   {"distance", "max", false},
    {"excess", "median", false},     {"excess", "max", false},
    {"relabelling", "max", false},   {"psd_defect", "max", true},
    {"rounding", "median", true},    {"conditioned_rounding", "max", true},
    {"value_rounding", "max", true}, {"gradient_rounding", "max", true},
};

const Json& EntryOf(const Json& row, const FigureRule& rule) {
  static const Json kNull;
  const Json& figure = row.at("accuracy").at(rule.figure);
  if (figure.is_null()) return kNull;
  const Json& entry = figure.at(rule.entry);
  return entry.is_object() ? entry.at("value") : entry;
}

std::map<std::string, const Json*> Rows(const Json& result) {
  std::map<std::string, const Json*> rows;
  for (const Json& row : result.at("rows")) rows[RowKey(row)] = &row;
  return rows;
}

void CompareRow(const std::string& key, const Json& base, const Json& now,
                AccuracyComparison& comparison) {
  for (const char* what : {"count", "active"}) {
    if (base.at(what) != now.at(what)) {
      throw CompareError(fmt::format("{}: {} {} and {}: not the same configurations", key, what,
                                     base.at(what).dump(), now.at(what).dump()));
    }
  }
  for (const FigureRule& rule : kRules) {
    const Json &a = EntryOf(base, rule), &b = EntryOf(now, rule);
    const Loss loss = {key, fmt::format("{}, {}", rule.figure, rule.entry), a, b};
    if (Exceeds(Size(b), Size(a), rule.test_ratio)) comparison.losses.push_back(loss);
    if (Exceeds(Size(a), Size(b), rule.test_ratio)) comparison.gains.push_back(loss);
  }
  for (const auto& [verdict, count] : base.at("verdicts").items()) {
    const Json& other = now.at("verdicts").at(verdict);
    if (count == other || verdict == "pass") continue;
    (other > count ? comparison.losses : comparison.gains).push_back({key, verdict, count, other});
  }
  // With what float128 found in worst cases, where the result keeps that apart.
  const auto names = [](const Json& row) {
    std::set<std::string> properties;
    const auto add = [&](const Json& broken) {
      for (const Json& promise : broken) properties.insert(promise.at("property"));
    };
    add(row.at("broken_promises"));
    if (row.contains("worst_cases")) add(row.at("worst_cases").at("broken_promises"));
    return properties;
  };
  const std::set<std::string> before = names(base), after = names(now);
  const auto join = [](const std::set<std::string>& words) {
    return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
  };
  const Loss change = {key, "broken promises", join(before), join(after)};
  if (!std::ranges::includes(before, after)) comparison.losses.push_back(change);
  if (!std::ranges::includes(after, before)) comparison.gains.push_back(change);
}

}  // namespace

AccuracyComparison CompareAccuracy(const Json& base, const Json& now) {
  const auto of_base = Rows(base), of_new = Rows(now);
  AccuracyComparison comparison;
  comparison.only_base = Only(of_base, of_new);
  comparison.only_new = Only(of_new, of_base);
  for (const auto& [key, row] : of_base) {
    const auto other = of_new.find(key);
    if (other == of_new.end()) continue;
    ++comparison.rows;
    CompareRow(key, *row, *other->second, comparison);
  }
  if (comparison.rows == 0) throw CompareError("the two have no row in common");
  return comparison;
}

}  // namespace definite
