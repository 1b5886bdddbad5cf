#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "benchmarks/harness/report.hpp"
#include "fuzz/report.hpp"

namespace definite::fuzz {

namespace {

using Json = nlohmann::ordered_json;

// How one filter fared in one family, over all energies.
struct Fate {
  std::string family, filter;
  std::uint64_t cases = 0, failed = 0;
  int first = kDecades;  // the least degenerate decade where it failed
  std::map<std::string, std::uint64_t> verdicts;
  std::set<std::string> energies, failing;

  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Fate, family, filter, cases, failed, first, verdicts, energies,
                                 failing)
};

// By family and filter.
std::vector<Fate> FatesOf(const Json& cells) {
  std::map<std::pair<std::string, std::string>, Fate> fates;
  for (const auto& cell : cells) {
    const auto& energy = cell.at("energy").get_ref<const std::string&>();
    for (const auto& row : cell.at("rows")) {
      const std::string rest =
          row.at("kernels").at(0).get_ref<const std::string&>().substr(energy.size() + 1);
      const std::string filter = rest.substr(0, rest.find('/'));
      Fate& fate = fates[{cell.at("family"), filter}];
      fate.family = cell.at("family");
      fate.filter = filter;
      for (const auto& [verdict, count] : row.at("verdicts").items()) {
        if (verdict == "out_of_domain") continue;
        fate.cases += count.get<std::uint64_t>();
        fate.energies.insert(energy);
        if (verdict == "pass") continue;
        fate.failed += count.get<std::uint64_t>();
        fate.verdicts[verdict] += count.get<std::uint64_t>();
        fate.failing.insert(energy);
        fate.first = std::min(fate.first, cell.at("decade").get<int>());
      }
    }
  }
  std::vector<Fate> all;
  for (auto& [key, fate] : fates) all.push_back(std::move(fate));
  return all;
}

std::uint64_t CountOf(const Json& cells) {
  std::uint64_t count = 0;
  for (const auto& cell : cells) count += cell.at("count").get<std::uint64_t>();
  return count;
}

std::string From(int decade) { return decade == kDecades - 1 ? "0" : fmt::format("1e-{}", decade); }

std::string Share(std::uint64_t part, std::uint64_t whole) {
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(whole);
  return percent < 0.01 ? "< 0.01 %" : fmt::format("{:.2g} %", percent);
}

// The energies, by what they have in common where that is short.
std::string Some(const std::set<std::string>& some, std::size_t all) {
  if (some.size() == all) return "all";
  if (some.size() > 2) return fmt::format("{} of {}", some.size(), all);
  std::vector<std::string> names;
  for (const std::string& name : some) {
    names.push_back(fmt::format("`{}`", name.starts_with("collision/") ? name.substr(10) : name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

nlohmann::ordered_json Summary(Json result) {
  Json& fuzz = result.at("fuzz");
  if (fuzz.contains("summary")) return result;
  const Json cells = std::move(fuzz.at("cells"));
  fuzz["cells"] = Json::array();
  fuzz["summary"]["configurations"] = CountOf(cells);
  fuzz["summary"]["fates"] = Json::array();
  for (const Fate& fate : FatesOf(cells)) {
    fuzz["summary"]["fates"].emplace_back(nlohmann::json(fate));
  }
  return result;
}

std::string ToMarkdown(const nlohmann::ordered_json& result) {
  const Json summary = Summary(result).at("fuzz").at("summary");
  std::string text = fmt::format(
      "# Where filters fail\n\n"
      "Written by `definite fuzz --from`; do not edit. {} configurations near a degeneracy, seed "
      "{}:\n"
      "`{}`.\n\n"
      "delta is how degenerate a configuration is, from 1 down to 1e-16, and 0. A filter fails in "
      "a\n"
      "configuration where its verdict is not `pass` (protocol.md, section 1); `none`, the Hessian "
      "as\n"
      "it is, is not a filter. Shares are of the active configurations inside the domain, which\n"
      "crowd at small delta as no simulation does. Degraded: far from the filter's own "
      "definition,\n"
      "or larger than four times the Hessian.\n",
      WithCommas(summary.at("configurations").get<std::uint64_t>()),
      result.at("fuzz").at("plan").at("seed").dump(),
      fmt::join(result.at("command").get<std::vector<std::string>>(), " "));
  std::map<std::string, std::vector<Fate>> of_family;
  for (const nlohmann::json fate : summary.at("fates")) {
    of_family[fate.at("family")].push_back(fate.get<Fate>());
  }
  for (const auto& [name, fates] : of_family) {
    const auto family = std::ranges::find(AllFamilies(), name, &Family::name);
    text += fmt::format("\n## {}\n\ndelta: {}. {}\n\n", name, family->meaning, family->remedy);
    text += "| filter | fails from delta | share | how | energies |\n|---|--:|--:|---|---|\n";
    std::vector<std::string> passing;
    for (const Fate& fate : fates) {
      if (fate.filter == "none" || fate.cases == 0) continue;
      if (fate.failed == 0) {
        passing.push_back(fmt::format("`{}`", fate.filter));
        continue;
      }
      std::vector<std::string> how;
      for (const auto& [verdict, count] : fate.verdicts) {
        how.push_back(fmt::format("{} {}", verdict, Share(count, fate.cases)));
      }
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", fate.filter, From(fate.first),
                          Share(fate.failed, fate.cases), fmt::join(how, ", "),
                          Some(fate.failing, fate.energies.size()));
    }
    text += fmt::format("\nNo failure: {}.\n",
                        passing.empty() ? "none" : fmt::format("{}", fmt::join(passing, ", ")));
  }
  return text;
}

}  // namespace definite::fuzz
