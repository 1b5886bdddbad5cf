// What an earlier, independent study found where `definite reproduce first-study` cannot look: the
// paper's filters of clamped distances against the exact Hessian, which belongs to another energy
// of ours, and the mixed length on one side of the face.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "reference/oracle.hpp"

namespace definite {
namespace {

constexpr const char* kExact = "collision/edge_edge/unsigned/quadratic";
constexpr const char* kFrozen = "collision/edge_edge/unsigned_frozen/quadratic";
constexpr const char* kHybrid = "collision/edge_edge/hybrid/quadratic";

// By the length: its sign, or whether |l| < eps. The study took its pairs inside like this, while a
// penalty acts there however deep they are.
enum class Keep { kAll, kPositive, kNegative, kWithinEps };

struct Quantiles {
  double median, p95;
};

// Of the distance between what a filter makes of one energy and the nearest PSD matrix of the
// Hessian of another, over the pairs where that acts.
Quantiles Distance(const std::string& energy, const std::string& filter, const std::string& exact,
                   const char* distribution, double side, Keep keep = Keep::kAll) {
  constexpr std::int64_t kPairs = 40'000;
  const KernelRow& row = *FindKernel(energy + "/" + filter + "/f64");
  const KernelRow& nearest = *FindKernel(exact + "/numeric/f64");
  const auto& reference = *reference::FindEnergy<double>(exact);
  const ParameterValue overrides[] = {{"side", side}};
  Batch batch(*nearest.energy, overrides);
  batch.Draw(*FindDistribution(distribution), 11, 0, kPairs);
  std::vector<double> distances, f(static_cast<std::size_t>(row.outputs)), p(f);
  for (std::int64_t i = 0; i < kPairs; ++i) {
    double classification[3];
    nearest.energy->classify(batch.X(i), batch.P(i), classification, 1);
    if (classification[0] != 1) continue;
    const double length = reference.length(batch.X(i), batch.P(i));
    if ((keep == Keep::kPositive && length < 0) || (keep == Keep::kNegative && length > 0) ||
        (keep == Keep::kWithinEps && std::abs(length) >= batch.P(i)[1])) {
      continue;
    }
    RunOne(row, batch.X(i), batch.P(i), f.data());
    RunOne(nearest, batch.X(i), batch.P(i), p.data());
    distances.push_back(RelativeDistance(f, p));
  }
  std::ranges::sort(distances);
  const auto at = [&](double q) {
    return distances[static_cast<std::size_t>(q * static_cast<double>(distances.size()))];
  };
  return {at(0.5), at(0.95)};
}

// `median` and `p95` as the study prints them, to two digits; 4 % for sampling and rounding, and
// more for a p95.
void ExpectNear(const Quantiles& ours, double median, double p95, const std::string& what) {
  EXPECT_NEAR(ours.median / median, 1, 0.04) << what;
  EXPECT_NEAR(ours.p95 / p95, 1, 0.12) << what;
}

struct Found {
  const char* distribution;
  double median, p95;
};

TEST(FirstStudy, FrozenWeightsAreGaussNewtonOutside) {
  for (const auto& [distribution, median, p95] :
       {Found{"normal", .29, .79}, {"paper", .85, .98}, {"active", .060, .23}}) {
    const Quantiles analytic = Distance(kFrozen, "analytic", kExact, distribution, 1);
    ExpectNear(analytic, median, p95, distribution);
    const Quantiles gauss_newton = Distance(kExact, "gauss_newton", kExact, distribution, 1);
    EXPECT_NEAR(analytic.median, gauss_newton.median, 1e-12);
    EXPECT_NEAR(analytic.p95, gauss_newton.p95, 1e-12);
  }
}

TEST(FirstStudy, FrozenWeightsAreFarFromTheProjectionInside) {
  for (const auto& [distribution, median, p95] :
       {Found{"normal", .96, 12}, {"paper", .85, 9.1}, {"active", 4.0, 29}}) {
    ExpectNear(Distance(kFrozen, "analytic", kExact, distribution, -1, Keep::kWithinEps), median,
               p95, distribution);
  }
}

// The one row of `definite reproduce first-study` that differs: within eps it agrees.
TEST(FirstStudy, TookPairsInsideWithinEps) {
  ExpectNear(Distance(kExact, "none", kExact, "normal", -1, Keep::kWithinEps), .61, 2.0, "within");
  EXPECT_GT(Distance(kExact, "none", kExact, "normal", -1).median, .69);
}

TEST(FirstStudy, HybridIsFarFromTheProjectionWhereAnEndpointIsNearest) {
  for (const auto& [distribution, median, p95] :
       {Found{"normal", .25, .90}, {"paper", .52, .92}, {"active", .048, .27}}) {
    ExpectNear(Distance(kHybrid, "analytic", kExact, distribution, 0, Keep::kWithinEps), median,
               p95, distribution);
  }
  for (const auto& [distribution, median, p95] :
       {Found{"normal", .69, .97}, {"paper", .94, .99}, {"active", .12, .41}}) {
    ExpectNear(Distance(kHybrid, "gauss_newton", kExact, distribution, 0, Keep::kWithinEps), median,
               p95, distribution);
  }
  for (const auto& [distribution, median, p95] :
       {Found{"normal", .46, 2.3}, {"paper", .85, 4.6}, {"active", .10, .42}}) {
    ExpectNear(Distance(kExact, "none", kExact, distribution, 0, Keep::kWithinEps), median, p95,
               distribution);
  }
}

TEST(FirstStudy, TheMixedLengthIsFarFromTheProjection) {
  struct Filter {
    const char* name;
    double median, p95;
  };
  const std::string face = "collision/vertex_face/anisotropic/quadratic";
  for (const auto& [filter, median, p95] :
       {Filter{"none", .049, .19}, {"gauss_newton", .054, .22}, {"analytic", .28, 5.2}}) {
    ExpectNear(Distance(face, filter, face, "active", 0, Keep::kPositive), median, p95, filter);
  }
  const std::string edges = "collision/edge_edge/anisotropic/quadratic";
  for (const auto& [filter, median, p95] :
       {Filter{"none", .23, .74}, {"gauss_newton", .25, .63}, {"analytic", 2.0, 15}}) {
    ExpectNear(Distance(edges, filter, edges, "active", 0, Keep::kNegative), median, p95, filter);
  }
}

}  // namespace
}  // namespace definite
