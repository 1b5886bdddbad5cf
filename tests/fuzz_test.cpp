// What hunts: child processes, symmetries, findings, the corpus. The command is tested from outside
// (fuzz_test.py).

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"
#include "benchmarks/harness/symmetries.hpp"
#include "fuzz/children.hpp"
#include "fuzz/findings.hpp"
#include "fuzz/zoo.hpp"
#include "tests/contracts.hpp"

namespace definite {
namespace {

constexpr const char* kEnergy = "collision/vertex_face/signed/quadratic";

const EnergyRow& Energy(std::string_view name) {
  return *std::ranges::find(AllEnergies(), name, &EnergyRow::name);
}

std::map<std::size_t, fuzz::Ended> InChildren(std::size_t count,
                                              const std::function<std::string(std::size_t)>& work) {
  std::map<std::size_t, fuzz::Ended> ended;
  fuzz::InChildren(count, 2, 0.3, work,
                   [&](std::size_t task, const fuzz::Ended& how) { ended[task] = how; });
  return ended;
}

TEST(Children, GiveBackWhatTheyWrite) {
  const auto ended = InChildren(5, [](std::size_t task) {
    return std::string(300'000 * task, static_cast<char>('a' + task));
  });
  ASSERT_EQ(ended.size(), 5u);
  for (const auto& [task, how] : ended) {
    EXPECT_TRUE(how.well);
    EXPECT_EQ(how.text, std::string(300'000 * task, static_cast<char>('a' + task)));
  }
}

TEST(Children, EndAloneHoweverTheyEnd) {
  const auto ended = InChildren(5, [](std::size_t task) -> std::string {
    if (task == 0) std::raise(SIGFPE);
    if (task == 1) throw std::runtime_error("it says why");
    if (task == 2) std::_Exit(3);
    std::atomic<bool> goes_on = task == 3;
    while (goes_on) {
    }
    return "well";
  });
  ASSERT_EQ(ended.size(), 5u);
  for (std::size_t task = 0; task < 4; ++task) EXPECT_FALSE(ended.at(task).well) << task;
  EXPECT_EQ(ended.at(0).text, "Floating point exception");
  EXPECT_EQ(ended.at(1).text, "it says why");
  EXPECT_EQ(ended.at(2).text, "exit code 3");
  EXPECT_EQ(ended.at(3).text, "no end in time");
  EXPECT_EQ(ended.at(4).text, "well");
}

// Of the exact Hessian of an ordinary configuration.
TEST(Symmetries, LeaveAHessianAsItIs) {
  for (const EnergyRow& energy : AllEnergies()) {
    const KernelRow& none = *FindKernel(energy.name + "/none/f64");
    const testing::Configuration c = testing::Configurations(energy).front();
    const std::vector<double> h = testing::Outputs(none, c.x, c.p);
    std::map<Property, int> seen;
    for (const Symmetry& symmetry : SymmetriesOf(energy)) {
      std::vector<double> x, p;
      if (!symmetry.Apply(energy, c.x.data(), c.p.data(), x, p)) continue;
      ++seen[symmetry.property];
      EXPECT_NE(std::pair(x, p), std::pair(c.x, c.p));
      EXPECT_LE(FrobeniusDistance(testing::Outputs(none, x, p), symmetry.Expected(h)),
                1e-12 / c.conditioning * FrobeniusNorm(h))
          << energy.name << " " << PropertyName(symmetry.property);
    }
    EXPECT_EQ(seen[Property::kRigidMotion], energy.dimension - 1) << energy.name;
    EXPECT_EQ(seen[Property::kRelabelling] > 0, !energy.relabellings.empty()) << energy.name;
    EXPECT_LE(OnTranslations(energy, h), 1e-12 / c.conditioning * FrobeniusNorm(h));
  }
}

TEST(Symmetries, LeaveOutWhatIsNotExact) {
  const EnergyRow& energy = Energy(kEnergy);
  std::vector<double> x(12, 0.0), p = {1, 0.1, 0}, new_x, new_p;
  x[0] = 1e-300;
  int exact = 0;
  for (const Symmetry& symmetry : SymmetriesOf(energy)) {
    if (symmetry.property == Property::kScale) {
      exact += symmetry.Apply(energy, x.data(), p.data(), new_x, new_p);
    }
  }
  EXPECT_EQ(exact, 1);  // larger, not smaller
}

// A hunt for one exhibit, and what it found.
struct Hunt {
  fuzz::Plan plan;
  std::vector<fuzz::Finding> findings;
};

Hunt HuntFor(const KernelRow& row, std::string_view family, int decade) {
  Hunt hunt;
  hunt.plan.rows = {&row};
  hunt.plan.families = {&*std::ranges::find(fuzz::AllFamilies(), family, &fuzz::Family::name)};
  hunt.plan.each = 16;
  hunt.plan.samples = {2, 2, 0};
  const fuzz::Cell cell = {42, row.energy, hunt.plan.families[0], decade};
  hunt.findings = FindingsOf(hunt.plan, {Check(hunt.plan, cell)});
  return hunt;
}

TEST(Findings, AreMadeSimpleAndStillShowIt) {
  const auto exhibit = std::ranges::find(fuzz::Exhibits(), "mirrors_small", &fuzz::Exhibit::name);
  const Hunt hunt = HuntFor(exhibit->row, "at_eps", 3);
  const auto finding = std::ranges::find(hunt.findings, "psd", &fuzz::Finding::what);
  ASSERT_NE(finding, hunt.findings.end());
  const fuzz::Example found = Found(*finding), simple = Shrunk(*finding);
  EXPECT_TRUE(Breaks(exhibit->row, "psd", found));
  EXPECT_TRUE(Breaks(exhibit->row, "psd", simple));
  EXPECT_FALSE(Breaks(*FindKernel(std::string(kEnergy) + "/nearest/f64"), "psd", simple));
  const auto digits = [](const fuzz::Example& example) {
    std::size_t count = 0;
    for (const double x : example.x) {
      int bits = 0;
      for (double rest = std::abs(x); rest != std::floor(rest); rest *= 2) ++bits;
      count += static_cast<std::size_t>(bits);
    }
    return count;
  };
  EXPECT_LT(digits(simple), digits(found) / 4);
}

TEST(Findings, AreNoneOfAGoodFilter) {
  EXPECT_TRUE(
      HuntFor(*FindKernel(std::string(kEnergy) + "/nearest/f64"), "at_eps", 3).findings.empty());
}

TEST(Findings, OfValueAndGradientHaveTheirPlace) {
  EnergyRow energy = Energy(kEnergy);
  energy.gradient = [](const double*, const double*, double* out, long count) {
    std::fill_n(out, 12 * count, 0.0);
  };
  KernelRow row = *FindKernel(std::string(kEnergy) + "/nearest/f64");
  row.energy = &energy;
  fuzz::Example example;
  Batch batch(energy);
  batch.Draw(*FindDistribution("active"), 1, 0, kTile);
  example.x.assign(batch.X(0), batch.X(0) + 12);
  example.p.assign(batch.P(0), batch.P(0) + 3);
  EXPECT_TRUE(Breaks(row, "consistent", example));
  row.energy = &Energy(kEnergy);
  EXPECT_FALSE(Breaks(row, "consistent", example));
}

// What was found once, never again.
TEST(Corpus, HoldsNothingThatBreaksARow) {
  int lines = 0;
  const std::filesystem::path folder = DEFINITE_SOURCE_DIR "/fuzz/corpus";
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const Distribution& distribution = *FindDistribution(file.path().string());
    const Recorded& recorded = *distribution.recorded;
    for (const EnergyRow& energy : AllEnergies()) {
      if (energy.stencil != recorded.stencil) continue;
      std::vector<const KernelRow*> rows;
      for (const KernelRow& row : AllKernels()) {
        if (row.energy == &energy) rows.push_back(&row);
      }
      Examiner examiner(energy, rows);
      Batch batch(energy);
      for (std::uint64_t i = 0; i < recorded.Size(); ++i, ++lines) {
        batch.Draw(distribution, 0, i, kTile);
        examiner.Examine(batch.X(0), batch.P(0), Depth::kTruth);
        for (std::size_t r = 0; r < rows.size(); ++r) {
          EXPECT_NE(examiner.Row(r).verdict, Verdict::kInconsistent)
              << file.path() << " " << energy.name;
          for (const Property property : examiner.Row(r).broken) {
            ADD_FAILURE() << file.path() << ": " << rows[r]->name << " is not "
                          << PropertyName(property);
          }
        }
      }
    }
  }
  EXPECT_GT(lines, 0);
}

}  // namespace
}  // namespace definite
