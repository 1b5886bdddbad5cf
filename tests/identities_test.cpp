// Energies and filters that are the same where the theory says so: the identities of
// benchmarks/verify, over more pairs than `definite verify --quick` takes, for every energy.

#include <gtest/gtest.h>

#include <algorithm>

#include "benchmarks/verify/verify.hpp"

namespace definite::verify {
namespace {

std::span<const Check> Identities() {
  static const std::vector<Check> checks = IdentityChecks();
  return checks;
}

Plan PlanOf(const Check& check) {
  Plan plan;
  for (const KernelRow& row : AllKernels()) {
    if (plan.subjects.empty() || plan.subjects.back().energy != row.energy) {
      plan.subjects.push_back(SubjectOf(*row.energy, {}));
    }
  }
  plan.checks = std::span(&check, 1);
  for (const Distribution& distribution : AllDistributions()) {
    plan.distributions.push_back(&distribution);
  }
  plan.seed = 7;
  plan.count = 256;
  return plan;
}

class Identity : public ::testing::TestWithParam<Check> {};

TEST_P(Identity, HoldsForDrawnPairs) {
  Progress progress(false);
  const Result result = RunChecks(PlanOf(GetParam()), progress);
  EXPECT_EQ(Failures(result), "");
  int energies = 0;
  for (const EnergyResult& energy : result.energies) {
    for (const CheckResult& check : energy.checks) {
      EXPECT_GE(check.configurations, 100u) << energy.subject.energy->name;
      ++energies;
    }
  }
  EXPECT_GE(energies, 1);
}

INSTANTIATE_TEST_SUITE_P(Verify, Identity,
                         ::testing::ValuesIn(Identities().begin(), Identities().end()),
                         [](const auto& p) { return std::string(p.param.name); });

}  // namespace
}  // namespace definite::verify
