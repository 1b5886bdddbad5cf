#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/compare/compare.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kVerdicts[] = {"same", "faster", "SLOWER"};

std::string Percent(double change) { return fmt::format("{:+.1f} %", 100 * change); }

std::string Interval(const MedianEstimate& ratio) {
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", ratio.median, ratio.low, ratio.high);
}

std::string Show(const Json& value) {
  if (value.is_string()) return value;
  return value.is_number_float() ? fmt::format("{:.4g}", value.get<double>()) : value.dump();
}

// The changed ones first, then by how much.
std::vector<const Compared*> Sorted(const Comparison& comparison) {
  std::vector<const Compared*> rows;
  for (const Compared& row : comparison.rows) rows.push_back(&row);
  std::ranges::stable_sort(rows, {}, [](const Compared* row) {
    return std::pair(-static_cast<int>(row->verdict), -row->ratio.median);
  });
  return rows;
}

std::string Listed(const char* what, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}: {}\n", what, name);
  return text;
}

template <class C>
std::string Unpaired(const C& comparison) {
  return Listed("missing from the new", comparison.only_base) +
         Listed("only in the new", comparison.only_new);
}

std::string Rule(const Comparison& comparison) {
  return fmt::format("noise floor {:.1f} % ({}), threshold {:.1f} %, false alarms {:.0f} %",
                     100 * comparison.floor,
                     comparison.floor_from_aa ? "A/A run" : "between its halves: drift not seen",
                     100 * comparison.limits.threshold, 100 * comparison.limits.q);
}

std::string Summary(const Comparison& comparison) {
  const auto count = [&](auto verdict) {
    return std::ranges::count(comparison.rows, verdict, &Compared::verdict);
  };
  return fmt::format("{} rows: {} slower, {} faster", comparison.rows.size(),
                     count(Compared::kSlower), count(Compared::kFaster));
}

std::string Summary(const AccuracyComparison& comparison) {
  return fmt::format("{} rows: {} figures worse, {} better", comparison.rows,
                     comparison.losses.size(), comparison.gains.size());
}

}  // namespace

std::string ToTable(const Comparison& comparison) {
  std::string table = fmt::format("{:>10} {:>10}  {:<22} {:>7}  {}\n", "old ns", "new ns",
                                  "new / old [95 %]", "p", "verdict");
  for (const Compared* row : Sorted(comparison)) {
    table +=
        fmt::format("{:>10.1f} {:>10.1f}  {:<22} {:>7.2g}  {}\n  {}\n", row->base_ns, row->new_ns,
                    Interval(row->ratio), row->p, kVerdicts[row->verdict], row->key);
  }
  return table + Unpaired(comparison) + Summary(comparison) + "\n" + Rule(comparison) + "\n";
}

std::string ToTable(const AccuracyComparison& comparison) {
  std::string table;
  for (const auto& [what, changes] :
       {std::pair("WORSE", &comparison.losses), std::pair("better", &comparison.gains)}) {
    for (const Loss& loss : *changes) {
      table += fmt::format("{:<6} {}: {} -> {}\n  {}\n", what, loss.figure, Show(loss.base),
                           Show(loss.now), loss.row);
    }
  }
  return table + Unpaired(comparison) + Summary(comparison) + "\n";
}

std::string ToMarkdown(const Comparison& comparison) {
  std::string text =
      fmt::format("### {}\n\n{}; {}.\n", comparison.Regressed() ? "Slower" : "Not slower",
                  Summary(comparison), Rule(comparison));
  text += "\n| row | old ns | new ns | change | new / old [95 %] | p | |\n";
  text += "|---|--:|--:|--:|--:|--:|---|\n";
  for (const Compared* row : Sorted(comparison)) {
    text += fmt::format("| {} | {:.1f} | {:.1f} | {} | {} | {:.2g} | {} |\n", row->key,
                        row->base_ns, row->new_ns, Percent(row->ratio.median - 1),
                        Interval(row->ratio), row->p, kVerdicts[row->verdict]);
  }
  for (const std::string& name : comparison.only_base) text += fmt::format("\nMissing: {}\n", name);
  for (const std::string& name : comparison.only_new) text += fmt::format("\nNew: {}\n", name);
  return text;
}

std::string ToMarkdown(const AccuracyComparison& comparison) {
  std::string text =
      fmt::format("### {}\n\n{}.\n", comparison.losses.empty() ? "As accurate" : "Less accurate",
                  Summary(comparison));
  if (!comparison.losses.empty() || !comparison.gains.empty()) {
    text += "\n| row | figure | old | new | |\n|---|---|--:|--:|---|\n";
  }
  for (const auto& [what, changes] :
       {std::pair("WORSE", &comparison.losses), std::pair("better", &comparison.gains)}) {
    for (const Loss& loss : *changes) {
      text += fmt::format("| {} | {} | {} | {} | {} |\n", loss.row, loss.figure, Show(loss.base),
                          Show(loss.now), what);
    }
  }
  for (const std::string& name : comparison.only_base) text += fmt::format("\nMissing: {}\n", name);
  for (const std::string& name : comparison.only_new) text += fmt::format("\nNew: {}\n", name);
  return text;
}

Json ToJson(const Comparison& comparison) {
  Json json = {{"floor", comparison.floor},
               {"floor_from", comparison.floor_from_aa ? "a/a" : "halves"},
               {"threshold", comparison.limits.threshold},
               {"q", comparison.limits.q},
               {"regressed", comparison.Regressed()},
               {"rows", Json::array()},
               {"missing", comparison.only_base},
               {"new", comparison.only_new}};
  for (const Compared& row : comparison.rows) {
    json["rows"].push_back({{"row", row.key},
                            {"base_ns", row.base_ns},
                            {"new_ns", row.new_ns},
                            {"ratio",
                             {{"median", row.ratio.median},
                              {"minimum", row.ratio.minimum},
                              {"low", row.ratio.low},
                              {"high", row.ratio.high}}},
                            {"p", row.p},
                            {"verdict", row.verdict == Compared::kSame     ? "same"
                                        : row.verdict == Compared::kFaster ? "faster"
                                                                           : "slower"}});
  }
  return json;
}

Json ToJson(const AccuracyComparison& comparison) {
  Json json = {{"rows", comparison.rows},
               {"worse", Json::array()},
               {"better", Json::array()},
               {"missing", comparison.only_base},
               {"new", comparison.only_new}};
  const auto add = [](Json& list, const std::vector<Loss>& changes) {
    for (const Loss& loss : changes) {
      list.push_back(
          {{"row", loss.row}, {"figure", loss.figure}, {"base", loss.base}, {"new", loss.now}});
    }
  };
  add(json["worse"], comparison.losses);
  add(json["better"], comparison.gains);
  return json;
}

}  // namespace definite
