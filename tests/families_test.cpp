// Families of degenerate configurations: that they are what they say, and that what is inherent in
// them is no fault of a filter, while a fault is still one.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "benchmarks/advice/degeneracies.hpp"
#include "benchmarks/harness/examine.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "fuzz/family.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"
#include "tests/exhibits.hpp"

namespace definite::fuzz {
namespace {

constexpr Parameter kParameters[] = {{"k", 1, 0, ""}, {"eps", 0.1, 1, ""}};

const Family& FamilyNamed(std::string_view name) {
  for (const Family& family : AllFamilies()) {
    if (family.name == name) return family;
  }
  throw std::runtime_error(std::string(name));
}

std::vector<double> Configuration(const Family& family, const Genes& genes,
                                  std::string_view stencil) {
  std::vector<double> x(12), p(2);
  Make(family, genes, {stencil, 12, kParameters}, x.data(), p.data());
  return x;
}

Genes GenesOf(double delta, bool negative = false) {
  return {delta,
          negative,
          Genes::kAxes,
          {0.3, 0.6, 0.2, 0.7, 0.25, 0.4, 0.5, 0.8, 0.1, 0.6, 0.9, 0.35}};
}

TEST(Genes, DeltaIsLogUniformInSixteenDecadesAndZeroInOneOfSeventeen) {
  constexpr int kCount = 100'000;
  int zero = 0, negative = 0;
  std::vector<int> decades(16), poses(3);
  for (int i = 0; i < kCount; ++i) {
    Draws draws(1, 2, static_cast<std::uint64_t>(i));
    const Genes genes = DrawGenes(draws);
    negative += genes.negative;
    ++poses[genes.pose];
    if (genes.delta == 0) {
      ++zero;
      continue;
    }
    const double decade = -std::log10(genes.delta);
    ASSERT_GE(decade, 0);
    ASSERT_LT(decade, 16);
    ++decades[static_cast<std::size_t>(decade)];
  }
  // Five standard deviations.
  const auto near = [](int count, double share) {
    return std::abs(count - kCount * share) < 5 * std::sqrt(kCount * share * (1 - share));
  };
  EXPECT_TRUE(near(zero, 1. / 17)) << zero;
  EXPECT_TRUE(near(negative, 0.5)) << negative;
  for (const int count : decades) EXPECT_TRUE(near(count, 1. / 17)) << count;
  EXPECT_TRUE(near(poses[0], 0.25) && near(poses[1], 0.25) && near(poses[2], 0.5));
}

TEST(Genes, ADecadeIsThatDecade) {
  for (int decade = 0; decade < 16; ++decade) {
    for (int i = 0; i < 100; ++i) {
      Draws draws(1, 2, static_cast<std::uint64_t>(i));
      const double delta = DrawGenes(draws, decade).delta;
      EXPECT_GE(delta, 0.998 * std::pow(10.0, -decade - 1));  // ShortPower is good to 1e-3
      EXPECT_LE(delta, 1.002 * std::pow(10.0, -decade));
    }
  }
  Draws draws(1, 2, 3);
  EXPECT_EQ(DrawGenes(draws, 16).delta, 0);
}

// By the independent measures of definite advise.
TEST(Families, HaveTheDegeneracyTheyClaim) {
  const auto measured = [](std::string_view degeneracy, std::string_view stencil,
                           const std::vector<double>& x) {
    for (const Degeneracy& d : AllDegeneracies()) {
      if (d.name == degeneracy) return d.delta(stencil, x.data());
    }
    throw std::runtime_error(std::string(degeneracy));
  };
  for (const double delta : {1e-2, 1e-5, 1e-9}) {
    const auto of = [&](const char* family, bool negative, std::string_view stencil) {
      return Configuration(FamilyNamed(family), GenesOf(delta, negative), stencil);
    };
    EXPECT_NEAR(measured("edge_angle", "edge_edge", of("edge_angle", false, "edge_edge")) / delta,
                1, 1e-6);
    // Of ordinary shapes the other measures are within a factor of ten of 1.
    for (const bool negative : {false, true}) {
      for (const char* stencil : {"vertex_face", "edge_edge"}) {
        const double shortest =
            measured("short_edge", stencil, of("short_edge", negative, stencil));
        EXPECT_GT(shortest, delta / 10);
        EXPECT_LT(shortest, delta * 10);
        const double touching = measured("touching", stencil, of("touching", negative, stencil));
        EXPECT_GT(touching, delta / 100);
        EXPECT_LT(touching, delta);
        const double foot = measured("far_foot", stencil, of("far_foot", negative, stencil));
        EXPECT_GT(foot, delta / 2);
        EXPECT_LT(foot, delta * 2);
        const double deep = measured("tiny", stencil, of("deep", negative, stencil));
        EXPECT_GT(deep, delta / 10);
        EXPECT_LT(deep, delta * 10);
      }
    }
    const double sliver = measured("sliver", "vertex_face", of("sliver", false, "vertex_face"));
    EXPECT_GT(sliver, delta / 10);
    EXPECT_LT(sliver, delta);
  }
}

TEST(Families, PosesKeepTheShape) {
  // Turned, the lengths of edges and the distance are the same to rounding; axes have zeros.
  for (const char* stencil : {"vertex_face", "edge_edge"}) {
    Genes genes = GenesOf(0.01);
    const std::vector<double> axes = Configuration(FamilyNamed("touching"), genes, stencil);
    genes.pose = Genes::kTurned;
    const std::vector<double> turned = Configuration(FamilyNamed("touching"), genes, stencil);
    EXPECT_EQ(std::ranges::count(turned, 0.0), 3);  // the vertex at the origin
    EXPECT_GT(std::ranges::count(axes, 0.0), 4);    // edges in the plane z = 0, one along x
    for (std::size_t v = 0; v < 12; v += 3) {
      for (std::size_t w = 0; w < v; w += 3) {
        const auto distance = [&](const std::vector<double>& x) {
          return std::hypot(x[v] - x[w], x[v + 1] - x[w + 1], x[v + 2] - x[w + 2]);
        };
        EXPECT_NEAR(distance(axes), distance(turned), 1e-15);
      }
    }
  }
}

TEST(Families, AreFoundByTheirNamesAndNoOthers) {
  std::set<std::string_view> names;
  for (const Family& family : AllFamilies()) {
    names.insert(family.name);
    const std::string name = "fuzz/" + std::string(family.name);
    ASSERT_NE(FindDistribution(name), nullptr);
    EXPECT_EQ(FindDistribution(name)->name, name);
    EXPECT_EQ(FindDistribution(name), FindDistribution(name));
    EXPECT_NE(FindDistribution(name + "/16"), nullptr);
    EXPECT_NE(FindDistribution(name + "/16"), FindDistribution(name));
  }
  EXPECT_EQ(names.size(), AllFamilies().size());
  for (const char* name : {"fuzz/", "fuzz/edges", "edge_angle", "fuzz/edge_angle/17",
                           "fuzz/edge_angle/-1", "fuzz/edge_angle/", "fuzz/edge_angle/1x"}) {
    EXPECT_EQ(FindDistribution(name), nullptr) << name;
  }
}

// What the generators give must not change: results name configurations by their index.
TEST(Families, GiveTheSameBitsEverywhere) {
  std::uint64_t hash = StreamId("");
  for (const Family& family : AllFamilies()) {
    const Distribution& distribution = *FindDistribution("fuzz/" + std::string(family.name));
    for (const std::string_view stencil : family.stencils) {
      for (std::uint64_t index = 0; index < 50; ++index) {
        std::vector<double> x(12), p(2);
        distribution.draw({stencil, 12, kParameters}, 42, index, x.data(), p.data());
        for (const double value : x) {
          hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
        }
      }
    }
  }
  EXPECT_EQ(hash, 8209557109681986818u);
}

// Judges a row at configurations of a family, whatever there is of it.
struct Judged {
  int active = 0, broken = 0, inaccurate = 0, degraded = 0, inconsistent = 0;
};
Judged Judge(const EnergyRow& energy, const KernelRow& row, const std::string& family, int count) {
  Judged judged;
  const KernelRow* const rows[] = {&row};
  Examiner examiner(energy, rows);
  Batch batch(energy);
  batch.Draw(*FindDistribution("fuzz/" + family), 42, 0, count);
  for (int i = 0; i < count; ++i) {
    examiner.Examine(batch.X(i), batch.P(i), Depth::kTruth);
    judged.active += examiner.Configuration().active;
    const std::vector<Property>& broken = examiner.Row(0).broken;
    judged.broken += !broken.empty();
    judged.inaccurate += std::ranges::find(broken, Property::kAccurate) != broken.end();
    judged.degraded += examiner.Row(0).verdict == Verdict::kDegraded;
    judged.inconsistent += examiner.Row(0).verdict == Verdict::kInconsistent;
  }
  return judged;
}

class Inherent : public ::testing::TestWithParam<const char*> {};

TEST_P(Inherent, IsNoFaultOfAFilter) {
  const KernelRow& row = *FindKernel("collision/edge_edge/signed/quadratic/split/f64");
  const Judged judged = Judge(*row.energy, row, GetParam(), 160);
  EXPECT_GT(judged.active, 50);
  EXPECT_EQ(judged.broken, 0);
  EXPECT_EQ(judged.degraded, 0);
  EXPECT_EQ(judged.inconsistent, 0);
}

INSTANTIATE_TEST_SUITE_P(Families, Inherent,
                         ::testing::Values("edge_angle", "short_edge", "touching", "at_eps",
                                           "far_foot", "deep", "corner_region", "coincident",
                                           "scale", "shift"),
                         [](const auto& family) { return std::string(family.param); });

TEST(Neighbours, DoNotExcuseAFilterThatRoundsToSingle) {
  using Energy = Collision<Signed<VertexFace>, Quadratic>;
  EnergyTable table =
      MakeTable<Energy>(Filters<testing::Spoilt<testing::SinglePrecisionConstant>>());
  KernelRow row = table.kernels.front();
  const EnergyRow& energy = *FindKernel("collision/vertex_face/signed/quadratic/none/f64")->energy;
  row.energy = &energy;
  for (const char* family : {"touching", "corner_region", "coincident", "shift"}) {
    const Judged judged = Judge(energy, row, family, 80);
    EXPECT_GT(judged.inaccurate, judged.active * 9 / 10) << family;
  }
}

}  // namespace
}  // namespace definite::fuzz
