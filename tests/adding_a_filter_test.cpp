// The example of docs/adding-a-filter.md does what the page says.

#include <gtest/gtest.h>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "example/kernels.hpp"
#include "example/reference.hpp"
#include "kernels/energies/collision_signed.hpp"
#include "reference/oracle.hpp"

namespace definite {
namespace {

TEST(AddingAFilter, GivesRowsThatAreWhatTheyMean) {
  using Energy = Collision<Signed<EdgeEdge>, Quadratic>;
  const EnergyTable table = MakeTable<Energy>(Filters<HalfAbsolute>());
  ASSERT_EQ(table.kernels.size(), 2u);
  EXPECT_EQ(table.kernels[0].name, "collision/edge_edge/signed/quadratic/half_absolute/f64");
  EXPECT_FALSE(table.kernels[0].Promises(Property::kRelabelling));
  EXPECT_TRUE(table.kernels[0].Promises(Property::kPsd));
  Batch batch(table.energy);
  batch.Draw(*FindDistribution("active"), 5, 0, 16);
  std::vector<double> f(16 * 78);
  table.kernels[0].run(batch.X(0), batch.P(0), f.data(), 16);
  for (int i = 0; i < 16; ++i) {
    reference::Truth<double> truth(*reference::FindEnergy<double>(table.energy.name), batch.X(i),
                                   batch.P(i));
    const auto m = reference::HalfAbsolute::Define(truth);
    std::vector<double> expected;
    for (int r = 0; r < 12; ++r) {
      for (int c = r; c < 12; ++c) expected.push_back(m(r, c));
    }
    EXPECT_LT(RelativeDistance({f.data() + i * 78, 78}, expected), 1e-10);
  }
}

}  // namespace
}  // namespace definite
