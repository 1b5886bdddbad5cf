// A kernel has no branches that a coverage tool could count: what it decides it decides by Select.
// Each of them goes both ways somewhere in the families of degenerate configurations, or
// tests/selects.txt says why it cannot.

#include "tests/selects.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "benchmarks/harness/sampling/batch.hpp"
#include "fuzz/family.hpp"

namespace definite::testing {

namespace {

constexpr std::int64_t kConfigurations = 32;  // of each decade of a family

SelectOutcomes OutcomesOfFamilies() {
  SelectOutcomes outcomes;
  Counting::selects = &outcomes;
  for (const Traced& traced : AllTraced()) {
    const auto energy = std::ranges::find(AllEnergies(), traced.energy, &EnergyRow::name);
    for (const fuzz::Family& family : fuzz::AllFamilies()) {
      if (!family.Has(energy->stencil)) continue;
      for (int decade = 0; decade < fuzz::kDecades; ++decade) {
        const std::string name = fmt::format("fuzz/{}/{}", family.name, decade);
        Batch batch(*energy);
        batch.Draw(*fuzz::FindFamily(name), 42, 0, kConfigurations);
        for (std::int64_t i = 0; i < kConfigurations; ++i) traced.run(batch.X(i), batch.P(i));
      }
    }
  }
  Counting::selects = nullptr;
  return outcomes;
}

// The Selects by name: the file below the project, and the text from there to the end of the line.
std::map<std::string, std::array<long, 2>> Named(const SelectOutcomes& outcomes) {
  std::map<std::string, std::array<long, 2>> named;
  for (const auto& [site, counts] : outcomes) {
    const auto& [file, line, column] = site;
    std::ifstream source(file);
    std::string text;
    for (unsigned i = 0; i < line; ++i) std::getline(source, text);
    auto& sum = named[std::filesystem::relative(file, DEFINITE_SOURCE_DIR).string() + ": " +
                      text.substr(column - 1)];
    sum[0] += counts[0];
    sum[1] += counts[1];
  }
  return named;
}

// "FILE: TEXT never|always", each with a line below that says why.
std::map<std::string, std::string> Unreachable() {
  std::map<std::string, std::string> reasons;
  std::ifstream list(DEFINITE_SOURCE_DIR "/tests/selects.txt");
  for (std::string line, why; std::getline(list, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (std::getline(list, why)) reasons[line] = why;
  }
  return reasons;
}

TEST(Selects, GoBothWaysInTheFamiliesOrAReasonIsGiven) {
  const auto outcomes = Named(OutcomesOfFamilies());
  ASSERT_GT(outcomes.size(), 100u);
  std::map<std::string, std::string> unreachable = Unreachable();
  int both = 0;
  for (const auto& [select, counts] : outcomes) {
    if (counts[0] > 0 && counts[1] > 0) {
      ++both;
      continue;
    }
    const std::string name = select + (counts[0] > 0 ? " always" : " never");
    const auto at = unreachable.find(name);
    EXPECT_NE(at, unreachable.end()) << name;
    if (at == unreachable.end()) continue;
    EXPECT_TRUE(at->second.starts_with("why: ")) << name;
    unreachable.erase(at);
  }
  for (const auto& [name, why] : unreachable) ADD_FAILURE() << name << ": goes both ways by now";
  RecordProperty("both", both);
  RecordProperty("all", static_cast<int>(outcomes.size()));
}

}  // namespace

}  // namespace definite::testing
