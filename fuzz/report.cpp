#include "fuzz/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <tuple>

#include "benchmarks/harness/report.hpp"

namespace definite::fuzz {

namespace {

using Json = nlohmann::ordered_json;

// How many cases got which verdict; those outside the domain are no cases.
struct Tally {
  std::array<std::uint64_t, kVerdictCount> verdicts{};

  void Add(const Json& counts) {
    for (std::size_t v = 0; v < verdicts.size(); ++v) {
      verdicts[v] += counts.value(std::string(kVerdictNames[v]), std::uint64_t{0});
    }
    verdicts[static_cast<std::size_t>(Verdict::kOutOfDomain)] = 0;
  }
  std::uint64_t Of(Verdict v) const { return verdicts[static_cast<std::size_t>(v)]; }
  std::uint64_t Total() const {
    std::uint64_t total = 0;
    for (const std::uint64_t n : verdicts) total += n;
    return total;
  }
  // Of those that did not pass.
  double Failing() const {
    const std::uint64_t total = Total();
    return total ? static_cast<double>(total - Of(Verdict::kPass)) / static_cast<double>(total) : 0;
  }
};

// Rounded so that only nothing is shown as nothing.
std::string Percent(std::uint64_t part, std::uint64_t whole) {
  if (part == 0) return "-";
  if (part == whole) return "100";
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(whole);
  if (percent < 0.01) return "<0.01";
  return fmt::format("{:.2f}", std::min(percent, 99.99));
}

}  // namespace

nlohmann::ordered_json HexNumbers(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double number : numbers) json.push_back(HexFloat(number));
  return json;
}

std::string ToTable(const Plan& plan, const std::vector<Json>& cells) {
  // A filter's rows of one energy that give the same bits are one.
  std::map<std::string, Tally> of_filter;
  std::map<std::string, std::map<std::string, Tally>> of_family;
  std::uint64_t configurations = 0;
  for (const Json& cell : cells) {
    configurations += cell.at("count").get<std::uint64_t>();
    for (const Json& row : cell.at("rows")) {
      const std::string filter(FindKernel(row.at("kernels").at(0).get<std::string>())->filter);
      of_filter[filter].Add(row.at("verdicts"));
      of_family[filter][cell.at("family")].Add(row.at("verdicts"));
    }
  }
  std::string table = fmt::format("{} configurations in {} cells of {} families, seed {}\n\n",
                                  WithCommas(configurations), WithCommas(cells.size()),
                                  plan.families.size(), plan.seed);
  table += fmt::format("{:<19}{:>8} |{:>7}{:>9}{:>9}{:>9}{:>7} | {}\n", "filter", "cases", "pass",
                       "degraded", "non-PSD", "not fin.", "zero", "worst in");
  for (const auto& [filter, tally] : of_filter) {
    const std::uint64_t total = tally.Total();
    if (total == 0) continue;
    const auto worst = std::ranges::max_element(
        of_family[filter], {}, [](const auto& entry) { return entry.second.Failing(); });
    const auto percent = [&](Verdict v) { return Percent(tally.Of(v), total); };
    table +=
        fmt::format("{:<19}{:>8} |{:>7}{:>9}{:>9}{:>9}{:>7} | {}\n", filter,
                    total < 10'000'000 ? std::to_string(total)
                                       : fmt::format("{:.2g}", static_cast<double>(total)),
                    percent(Verdict::kPass), percent(Verdict::kDegraded), percent(Verdict::kNonPsd),
                    percent(Verdict::kNonFinite), percent(Verdict::kSilentZero),
                    worst->second.Failing() > 0
                        ? fmt::format("{} ({:.2g} %)", worst->first, 100 * worst->second.Failing())
                        : "-");
  }
  return table + "\nShares in percent of the active cases inside the domain.\n";
}

std::string ToText(const Reported& reported) {
  const Finding& f = reported.finding;
  const std::string where = f.cell.decade == kDecades - 1
                                ? "at delta = 0"
                                : fmt::format("from delta = 1e-{} on", f.cell.decade);
  std::string text =
      f.what == "crash"
          ? fmt::format("{} ends the process: {}", f.cell.energy->name, f.how)
          : fmt::format("{} promises to be {} and is not", f.cell.energy->name, f.what);
  text +=
      fmt::format("\n  in fuzz/{}, {}, in {} of its cells", f.cell.family->name, where, f.cells);
  std::vector<std::string> rows;
  for (const KernelRow* row : f.rows) {
    rows.push_back(fmt::format("{}/{}", row->filter, row->scalar));
  }
  const std::size_t shown = std::min<std::size_t>(rows.size(), 4);
  text +=
      fmt::format("\n  rows: {}{}",
                  fmt::join(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                  shown < rows.size() ? fmt::format(" and {} more", rows.size() - shown) : "");
  if (rows.empty()) text += "none alone";
  if (const std::string command = ReplayCommand(f); !command.empty()) {
    text += fmt::format("\n  {}", command);
  }
  return text + "\n";
}

Json ToJson(const Plan& plan, std::size_t all_cells, const std::vector<Json>& cells,
            const std::vector<Reported>& findings) {
  Json json = {{"plan", ToJson(plan)}, {"all_cells", all_cells}, {"cells", cells}};
  json["findings"] = Json::array();
  for (const auto& [finding, example] : findings) {
    Json kernels = Json::array();
    for (const KernelRow* row : finding.rows) kernels.push_back(row->name);
    const bool is_crash = finding.what == "crash";
    json["findings"].push_back({{"energy", finding.cell.energy->name},
                                {"what", finding.what},
                                {"family", finding.cell.family->name},
                                {"decade", finding.cell.decade},
                                {"seed", finding.cell.seed},
                                {"index", finding.index},
                                {"cells", finding.cells},
                                {"kernels", kernels},
                                {"how", is_crash ? Json(finding.how) : Json()},
                                {"x", is_crash ? Json() : HexNumbers(example.x)},
                                {"p", is_crash ? Json() : HexNumbers(example.p)}});
  }
  return json;
}

Json DegeneracyMaps(const Json& fuzz) {
  constexpr Verdict kFromWorst[] = {
      Verdict::kCrash,  Verdict::kNonFinite, Verdict::kInconsistent, Verdict::kSilentZero,
      Verdict::kNonPsd, Verdict::kDegraded,  Verdict::kPass};
  struct Map {
    std::array<Tally, kDecades> tallies;
    std::map<std::string, std::array<Json, kDecades>> figures;
  };
  // Three digits are more than a chart shows.
  const auto rounded = [](const Json& number) {
    return number.is_string() ? number : Json::parse(fmt::format("{:.3g}", number.get<double>()));
  };
  const auto larger = [](const Json& a, const Json& b) {
    return b.is_null() || a.is_string() || (!b.is_string() && a > b);
  };
  std::map<std::tuple<std::string, std::string, std::string>, Map> maps;
  for (const Json& cell : fuzz.at("cells")) {
    const auto decade = cell.at("decade").get<std::size_t>();
    for (const Json& row : cell.at("rows")) {
      const auto& name = row.at("kernels").at(0).get_ref<const std::string&>();
      const auto& energy = cell.at("energy").get_ref<const std::string&>();
      // ENERGY/FILTER/SCALAR
      const std::string rest = name.substr(energy.size() + 1);
      Map& map = maps[{energy, cell.at("family"), rest.substr(0, rest.find('/'))}];
      map.tallies.at(decade).Add(row.at("verdicts"));
      for (const char* figure : {"distance", "rounding", "psd_defect", "relabelling"}) {
        const Json& of_row = row.at(figure);
        if (of_row.is_null()) continue;
        Json& most = map.figures[figure].at(decade);
        if (larger(of_row.at("max"), most)) most = rounded(of_row.at("max"));
      }
    }
  }
  Json json = Json::array();
  for (const auto& [key, map] : maps) {
    Json entry = {{"energy", std::get<0>(key)},
                  {"family", std::get<1>(key)},
                  {"filter", std::get<2>(key)},
                  {"verdict", Json::array()}};
    for (const Tally& tally : map.tallies) {
      const auto worst = std::ranges::find_if(kFromWorst, [&](Verdict v) { return tally.Of(v); });
      entry["verdict"].push_back(worst == std::end(kFromWorst)
                                     ? Json()
                                     : Json(kVerdictNames[static_cast<std::size_t>(*worst)]));
    }
    for (const auto& [figure, most] : map.figures) entry[figure] = most;
    json.push_back(std::move(entry));
  }
  return json;
}

std::string FamilyTable() {
  std::string table;
  for (const Family& family : AllFamilies()) {
    table += fmt::format("{:<15} {}\n{:<15}   of {}\n", family.name, family.meaning, "",
                         fmt::join(family.stencils, ", "));
  }
  return table;
}

}  // namespace definite::fuzz
