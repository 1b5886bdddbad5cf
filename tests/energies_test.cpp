// Every energy of the registry against the reference: where it acts, its value and gradient, and
// what it makes of distances of exactly eps, of degenerate shapes and of NaN.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "reference/closest_points.hpp"
#include "reference/oracle.hpp"
#include "tests/contracts.hpp"

namespace definite::testing {
namespace {

using reference::Quad;
using Numbers = std::vector<double>;
using Truth = reference::Truth<Quad>;

struct Where {
  bool active, in_domain;
};

Where Classify(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  double where[3];
  energy.classify(x.data(), p.data(), where, 1);
  return {where[0] == 1, where[1] == 1};
}

double Value(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  double value;
  energy.value(x.data(), p.data(), &value, 1);
  return value;
}

Numbers Gradient(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  Numbers gradient(static_cast<std::size_t>(energy.dofs));
  energy.gradient(x.data(), p.data(), gradient.data(), 1);
  return gradient;
}

Truth TruthOf(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  return {*reference::FindEnergy<Quad>(energy.name), x.data(), p.data()};
}

// The index of a parameter, or -1.
int IndexOf(const EnergyRow& energy, std::string_view name) {
  const auto at = std::ranges::find(energy.parameters, name, &Parameter::name);
  return at == energy.parameters.end() ? -1 : static_cast<int>(at - energy.parameters.begin());
}

Numbers Defaults(const EnergyRow& energy) {
  Numbers p;
  for (const Parameter& parameter : energy.parameters) p.push_back(parameter.value);
  return p;
}

// Whether rounding x cannot move the length of a collision across eps or 0.
bool IsDecided(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  const int eps = IndexOf(energy, "eps");
  if (eps < 0) return true;
  const double length = reference::FindEnergy<double>(energy.name)->length(x.data(), p.data());
  double largest = 0;
  for (double v : x) largest = std::max(largest, std::abs(v));
  const double slack = kRatioBound * kUnit * largest;
  return std::abs(length) > slack && std::abs(length - p[static_cast<std::size_t>(eps)]) > slack;
}

double Norm(const Numbers& v) {
  double sum = 0;
  for (double a : v) sum += a * a;
  return std::sqrt(sum);
}

double Norm(const reference::Matrix<Quad>& m) {
  return static_cast<double>(reference::FrobeniusNorm(m));
}

std::vector<const KernelRow*> RowsOf(const EnergyRow& energy) {
  std::vector<const KernelRow*> rows;
  for (const KernelRow& row : AllKernels()) {
    if (row.energy == &energy) rows.push_back(&row);
  }
  return rows;
}

bool AreParallel(const Numbers& edge_edge) {
  const auto e = reference::EdgeEdge::EdgesOf(edge_edge.data());
  return reference::Norm(reference::Cross(e.e0, e.e1)) == 0;
}

void ExpectNothing(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  EXPECT_FALSE(Classify(energy, x, p).active);
  EXPECT_EQ(Value(energy, x, p), 0);
  EXPECT_TRUE(AllZero(Gradient(energy, x, p)));
  for (const KernelRow* row : RowsOf(energy)) {
    // The printed formulas have no domain.
    if (row->filter == "analytic_printed" && !Classify(energy, x, p).in_domain) continue;
    EXPECT_TRUE(AllZero(Outputs(*row, x, p))) << row->name;
  }
}

// Mollified, parallel edges have a Hessian alone.
void ExpectAll(const EnergyRow& energy, const Numbers& x, const Numbers& p) {
  EXPECT_TRUE(Classify(energy, x, p).active);
  if (IndexOf(energy, "ex") >= 0 && AreParallel(x)) {
    EXPECT_EQ(Value(energy, x, p), 0);
    EXPECT_TRUE(AllZero(Gradient(energy, x, p)));
  } else {
    EXPECT_GT(Value(energy, x, p), 0);
    EXPECT_FALSE(AllZero(Gradient(energy, x, p)));
  }
  for (const KernelRow* row : RowsOf(energy)) {
    EXPECT_FALSE(AllZero(Outputs(*row, x, p))) << row->name;
  }
}

class EveryEnergy : public ::testing::TestWithParam<const EnergyRow*> {
 protected:
  const EnergyRow& energy_ = *GetParam();
};

class EveryCollision : public EveryEnergy {};

TEST_P(EveryEnergy, ActsWhereTheReferenceSays) {
  int active = 0;
  for (const Configuration& c : Configurations(energy_)) {
    if (!IsDecided(energy_, c.x, c.p)) continue;
    const Truth truth = TruthOf(energy_, c.x, c.p);
    const Where where = Classify(energy_, c.x, c.p);
    EXPECT_EQ(where.in_domain, truth.InDomain()) << c.name;
    EXPECT_EQ(where.active, truth.Active()) << c.name;
    active += where.active;
  }
  EXPECT_GE(active, 60);
}

// Errors in units of n u and of what a perturbation of x by one rounding does.
TEST_P(EveryEnergy, HasTheReferencesValueAndGradient) {
  int active = 0, inactive = 0;
  for (const Configuration& c : Configurations(energy_)) {
    if (!IsDecided(energy_, c.x, c.p)) continue;
    Truth truth = TruthOf(energy_, c.x, c.p);
    const double value = Value(energy_, c.x, c.p);
    const Numbers gradient = Gradient(energy_, c.x, c.p);
    if (!truth.Active()) {
      EXPECT_EQ(value, 0) << c.name;
      EXPECT_TRUE(AllZero(gradient)) << c.name;
      ++inactive;
      continue;
    }
    Numbers error;
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      error.push_back(static_cast<double>(gradient[i] - truth.Gradient()[static_cast<int>(i)]));
    }
    const double g = Norm(truth.Gradient()), x = Norm(c.x);
    const double bound = kRatioBound * energy_.dofs * kUnit / c.conditioning;
    EXPECT_LE(std::abs(static_cast<double>(value - truth.Value())),
              bound * (std::abs(value) + g * x))
        << c.name;
    EXPECT_LE(Norm(error), bound * (g + Norm(truth.Hessian()) * x)) << c.name;
    ++active;
  }
  EXPECT_GE(active, 60);
  EXPECT_GE(inactive, IndexOf(energy_, "eps") < 0 ? 0 : 1);
}

// Pairs at a distance of exactly h, on the positive side: over a face, between two edges that
// cross, a vertex over an edge, two vertices, parallel edges.
std::vector<Numbers> PairsAt(std::string_view stencil, double h) {
  if (stencil == "vertex_face") return {{0.25, 0.25, -h, 0, 0, 0, 1, 0, 0, 0, 1, 0}};
  if (stencil == "vertex_edge") return {{0.25, h, 0, 0, 0, 0, 1, 0, 0}};
  if (stencil == "vertex_vertex") return {{0, 0, 0, 0, 0, h}};
  return {{-1, 0, 0, 1, 0, 0, 0, -1, h, 0, 1, h},
          {-1, 0, 0, 1, 0, 0, 0, 0, h, 0, 0, h + 1},
          {-1, 0, 0, 1, 0, 0, 1 + h, 0, 0, 2 + h, 1, 0},
          {-1, 0, 0, 1, 0, 0, -1, 0, h, 1, 0, h}};
}

TEST_P(EveryCollision, ActsBelowItsActivationDistanceAndNotAtOrBeyondIt) {
  const double h = 0.5;
  int checked = 0;
  for (const Numbers& x : PairsAt(energy_.stencil, h)) {
    for (double side : {0.0, 1.0}) {
      Numbers p = Defaults(energy_);
      p[0] = 3.5;
      p[1] = h;
      p[2] = side;
      // Of edges side by side the signed length measures something else.
      if (reference::FindEnergy<double>(energy_.name)->length(x.data(), p.data()) != h) continue;
      ExpectNothing(energy_, x, p);
      EXPECT_TRUE(Classify(energy_, x, p).in_domain);
      p[1] = h / 2;
      ExpectNothing(energy_, x, p);
      p[1] = std::nextafter(h, 1);
      ExpectAll(energy_, x, p);
      ++checked;
    }
  }
  EXPECT_GE(checked, 2);
}

// Shapes that some energy has no Hessian for.
std::vector<Numbers> DegenerateShapes(std::string_view stencil) {
  if (stencil == "vertex_face") {
    return {{0.2, 0.1, 0.3, 0, 0, 0, 1, 0, 0, 2, 0, 0},       // collinear
            {0.2, 0.1, 0.3, 0, 0, 0, 1, 0, 0, 2, 1e-9, 0},    // nearly
            {0.2, 0.1, 0.3, 1, 0, 0, 1, 0, 0, 0, 1, 0},       // an edge of length zero
            {0.2, 0.1, 0.3, 1, 0, 0, 1, 1e-200, 0, 0, 1, 0},  // an edge too short
            {0.5, 0.5, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0},         // touching
            {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}};            // one point
  }
  if (stencil == "edge_edge") {
    return {{0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1},     // parallel
            {0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1e-9, 1},  // nearly
            {-1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1, 0},   // crossing
            {0, 0, 0, 1, 0, 0, 1, 0, 0, 2, 1, 0},     // touching at an end
            {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 1},     // an edge of length zero
            {0, 0, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0},     // the other
            {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}};    // one point
  }
  if (stencil == "vertex_edge") {
    return {{0.5, 0, 0, 0, 0, 0, 1, 0, 0},  // on the edge
            {5, 0, 0, 0, 0, 0, 1, 0, 0},    // on its line
            {0.5, 1, 0, 1, 0, 0, 1, 0, 0},  // an edge of length zero
            {1, 2, 3, 1, 2, 3, 1, 2, 3}};   // one point
  }
  if (stencil == "vertex_vertex" || stencil == "segment") {
    return {{0, 0, 0, 0, 0, 0}, {1, 2, 3, 1, 2, 3}, {1e300, 0, 0, 1e300, 0, 0}};  // one point
  }
  if (stencil == "torsion") {
    return {{-1, 0, 0, 0, 0, 0, 2, 0, 0, 3, 1, 0},    // straight at the first corner
            {0, 1, 0, 0, 0, 0, 2, 0, 0, 1, 1e-9, 0},  // folded at the second
            {0, 0, 0, 0, 0, 0, 2, 1, 0, 3, 1, 1},     // an edge of length zero
            {0, 1, 0, 0, 0, 0, 0, 0, 0, 3, 1, 1},     // the middle one
            {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}};    // one point
  }
  if (stencil == "triangle") {
    return {{0, 0, 1e40, 0, 0, 1e40},  // stretched beyond 2^100
            {0, 0, 0, -1e300, 1, 0},   // one edge alone
            {1, 1, 1, 1e200, 1, 1},    // and flat
            {0, 0, 1, 0, 2, 0},        // flat
            {0, 0, 1, 0, 0, -1},       // turned over
            {0, 0, 1, 0, 1, 1e-9},     // nearly flat
            {1, 2, 1, 2, 1, 2}};       // one point
  }
  if (stencil == "tetrahedron") {
    return {{0, 0, 0, 1e40, 0, 0, 0, 1e40, 0, 0, 0, 1e40},  // stretched beyond 2^100
            {0, 0, 0, 0, -1e300, 0, 1, 0, 0, 0, 0, 1},      // one edge alone
            {1, 1, 1, 1e200, 1, 1, 1, 1, 1, 2, 2, 2},       // and flat
            {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0},           // flat
            {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1},          // turned over
            {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1e-9},        // nearly flat
            {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}};          // one point
  }
  return {{-1, 0, 0, 0, 0, 0, 2, 0, 0},    // straight
          {1, 0, 0, 0, 0, 0, 2, 1e-9, 0},  // folded
          {0, 0, 0, 0, 0, 0, 2, 1, 0},     // an edge of length zero
          {1, 2, 3, 1, 2, 3, 1, 2, 3}};    // one point
}

TEST_P(EveryEnergy, IsZeroOutsideItsDomain) {
  int outside = 0;
  for (const Numbers& x : DegenerateShapes(energy_.stencil)) {
    Numbers p = Defaults(energy_);
    if (const int eps = IndexOf(energy_, "eps"); eps >= 0) p[static_cast<std::size_t>(eps)] = 10;
    const bool in_domain = Classify(energy_, x, p).in_domain;
    EXPECT_LE(in_domain, TruthOf(energy_, x, p).InDomain());
    if (in_domain) continue;
    ExpectNothing(energy_, x, p);
    ++outside;
  }
  EXPECT_GE(outside, 3);
}

// Where an energy acts, Gauss-Newton's matrix is the same for every eps and rest angle or length.
bool Reads(const KernelRow& row, std::string_view parameter) {
  return !(row.filter.starts_with("gauss_newton") &&
           (parameter == "eps" || parameter == "omega0" || parameter == "tau0" ||
            parameter == "length"));
}

TEST_P(EveryEnergy, PassesANaNOnToEveryRow) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto expect_nan = [&](const Numbers& x, const Numbers& p, std::string_view parameter) {
    SCOPED_TRACE(parameter);
    EXPECT_TRUE(std::isnan(Value(energy_, x, p)));
    EXPECT_FALSE(AllFinite(Gradient(energy_, x, p)));
    for (const KernelRow* row : RowsOf(energy_)) {
      EXPECT_TRUE(!Reads(*row, parameter) || !AllFinite(Outputs(*row, x, p))) << row->name;
    }
  };
  int checked = 0;
  for (const Configuration& c : Configurations(energy_)) {
    if (!c.well_conditioned || !Classify(energy_, c.x, c.p).active) continue;
    if (++checked > 12) break;
    for (std::size_t i = 0; i < c.p.size(); ++i) {
      const std::string_view name = energy_.parameters[i].name;
      // Of the side only the sign counts, and m only for l < 0.
      if (name == "side" || name == "m") continue;
      Numbers p = c.p;
      p[i] = kNaN;
      expect_nan(c.x, p, name);
    }
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      Numbers x = c.x;
      x[i] = kNaN;
      expect_nan(x, c.p, "x");
    }
  }
  EXPECT_GT(checked, 12);
}

std::vector<const EnergyRow*> Energies(std::string_view family) {
  std::vector<const EnergyRow*> energies;
  for (const EnergyRow& energy : AllEnergies()) {
    if (energy.name.starts_with(family)) energies.push_back(&energy);
  }
  return energies;
}

std::string TestName(const ::testing::TestParamInfo<const EnergyRow*>& info) {
  std::string name = info.param->name;
  std::ranges::replace(name, '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryEnergy, ::testing::ValuesIn(Energies("")), TestName);
INSTANTIATE_TEST_SUITE_P(Registry, EveryCollision, ::testing::ValuesIn(Energies("collision/")),
                         TestName);

TEST(EdgeEdge, TellsHowManyClosestPointsAreEnds) {
  for (const char* length : {"unsigned", "unsigned_frozen", "hybrid", "mollified"}) {
    const std::string name = "collision/edge_edge/" + std::string(length) + "/quadratic";
    const KernelRow* row = FindKernel(name + "/none/f64");
    if (!row) continue;  // of the energies that were left out
    const EnergyRow& energy = *row->energy;
    constexpr int kPairs = 256;
    Batch batch(energy);
    batch.Draw(*FindDistribution("normal"), 3, 0, kPairs);
    std::array<int, 3> seen{};
    for (int i = 0; i < kPairs; ++i) {
      const auto points = reference::FindClosestPoints(reference::EdgeEdge::EdgesOf(batch.X(i)));
      const int ends = !points.a_inside + !points.b_inside;
      double where[3];
      energy.classify(batch.X(i), batch.P(i), where, 1);
      EXPECT_EQ(where[2], ends) << length << " " << i;
      ++seen.at(static_cast<std::size_t>(ends));
    }
    EXPECT_GE(std::ranges::min(seen), 10) << length;
  }
}

}  // namespace
}  // namespace definite::testing
