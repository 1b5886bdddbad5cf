// Energies and filters that are the same where the theory says so, over drawn pairs of every
// distribution.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/harness/batch.hpp"
#include "benchmarks/harness/figures.hpp"
#include "reference/oracle.hpp"

namespace definite {
namespace {

using Numbers = std::vector<double>;

constexpr const char* kFaceSigned = "collision/vertex_face/signed/quadratic";
constexpr const char* kFaceUnsigned = "collision/vertex_face/unsigned/quadratic";
constexpr const char* kEdgeSigned = "collision/edge_edge/signed/quadratic";
constexpr const char* kEdgeUnsigned = "collision/edge_edge/unsigned/quadratic";
constexpr const char* kEdgeFrozen = "collision/edge_edge/unsigned_frozen/quadratic";
constexpr const char* kEdgeHybrid = "collision/edge_edge/hybrid/quadratic";
constexpr const char* kEdgeMollified = "collision/edge_edge/mollified/quadratic";

const KernelRow& Row(const std::string& energy, const std::string& filter) {
  return *FindKernel(energy + "/" + filter + "/f64");
}

// One pair as an energy with a side sees it.
struct Pair {
  std::string energy;
  Numbers x, p;

  Pair Of(const std::string& other, double side) const { return {other, x, {p[0], p[1], side}}; }
  const EnergyRow& Energy() const { return *Row(energy, "none").energy; }

  Numbers Filtered(const std::string& filter) const {
    const KernelRow& row = Row(energy, filter);
    Numbers out(static_cast<std::size_t>(row.outputs));
    RunOne(row, x.data(), p.data(), out.data());
    return out;
  }
  double Value() const {
    double value;
    Energy().value(x.data(), p.data(), &value, 1);
    return value;
  }
  Numbers Gradient() const {
    Numbers gradient(12);
    Energy().gradient(x.data(), p.data(), gradient.data(), 1);
    return gradient;
  }
  bool IsActive() const { return Classified(0) == 1; }
  bool IsInterior() const { return Classified(2) == 0; }
  // Of the triple product, which is that of the signed length with side 0.
  int Sign() const {
    const bool face = Energy().stencil == "vertex_face";
    const double p0[] = {p[0], p[1], 0};
    return Reference(face ? kFaceSigned : kEdgeSigned).length(x.data(), p0) < 0 ? -1 : 1;
  }
  double Length() const { return Reference(energy).length(x.data(), p.data()); }
  double Conditioning() const { return Reference(energy).conditioning(x.data(), p.data()); }

 private:
  double Classified(int which) const {
    double where[3];
    Energy().classify(x.data(), p.data(), where, 1);
    return where[which];
  }
  static const reference::Energy<double>& Reference(const std::string& name) {
    return *reference::FindEnergy<double>(name);
  }
};

// Calls check(pair) for drawn pairs of an energy that act, with each side and k = 1.7; check says
// whether it was of use. At least `least` of each distribution and side must be. Returns how many
// were.
template <class Check>
int ForDrawn(const std::string& energy, int least, Check check) {
  constexpr int kPairs = 256;
  int all = 0;
  for (const Distribution& distribution : AllDistributions()) {
    const EnergyRow& row = *Row(energy, "none").energy;
    Batch batch(row);
    batch.Draw(distribution, 7, 0, kPairs);
    for (double side : {0.0, 1.0, -1.0}) {
      int used = 0;
      for (int i = 0; i < kPairs; ++i) {
        const double *x = batch.X(i), *p = batch.P(i);
        Pair pair = {energy, Numbers(x, x + row.dofs), Numbers(p, p + row.parameters.size())};
        pair.p[0] = 1.7;
        pair.p[2] = side;
        SCOPED_TRACE(std::string(distribution.name) + " " + std::to_string(i));
        if (pair.IsActive()) used += check(pair);
      }
      EXPECT_GE(used, least) << energy << " " << distribution.name << " side " << side;
      all += used;
    }
  }
  return all;
}

// |f - g| in units of n u `scale`, conditioned.
double Ratio(const Numbers& f, const Numbers& g, double scale, double conditioning) {
  const double distance = FrobeniusDistance(f, g);
  return distance == 0 ? 0 : distance / scale * conditioning / (PackedRows(f) * kUnit);
}

void ExpectSameMatrix(const Pair& one, const Pair& other, const std::string& filter) {
  const Numbers f = one.Filtered(filter), g = other.Filtered(filter);
  EXPECT_GT(FrobeniusNorm(f), 0);
  EXPECT_LE(Ratio(f, g, FrobeniusNorm(f), one.Conditioning()), kRatioBound) << filter;
}

// Value, gradient and Hessian.
void ExpectSameEnergy(const Pair& one, const Pair& other) {
  EXPECT_TRUE(other.IsActive());
  EXPECT_DOUBLE_EQ(one.Value(), other.Value());
  const Numbers g = one.Gradient(), h = other.Gradient();
  for (std::size_t i = 0; i < 12; ++i) EXPECT_DOUBLE_EQ(g[i], h[i]) << i;
  ExpectSameMatrix(one, other, "none");
}

// The side of a signed length that makes it as negative as that of an unsigned pair.
double SignedSide(const Pair& pair) { return (pair.Length() < 0 ? -1 : 1) * pair.Sign(); }

TEST(Identity, AVertexAndAPlaneAreTheSameSignedAndUnsigned) {
  ForDrawn(kFaceUnsigned, 50, [](const Pair& pair) {
    ExpectSameEnergy(pair, pair.Of(kFaceSigned, SignedSide(pair)));
    return true;
  });
}

TEST(Identity, EdgesThatAreClosestInsideAreTheSameSignedAndUnsigned) {
  ForDrawn(kEdgeUnsigned, 5, [](const Pair& pair) {
    if (!pair.IsInterior()) return false;
    ExpectSameEnergy(pair, pair.Of(kEdgeSigned, SignedSide(pair)));
    return true;
  });
}

TEST(Identity, HybridIsSignedInside) {
  ForDrawn(kEdgeHybrid, 5, [](const Pair& pair) {
    if (!pair.IsInterior()) return false;
    const Pair other = pair.Of(kEdgeSigned, pair.p[2]);
    ExpectSameEnergy(pair, other);
    for (const char* filter : {"analytic", "absolute"}) ExpectSameMatrix(pair, other, filter);
    return true;
  });
}

// An unsigned length has the sign of the hybrid's where it is given that sign.
Pair Frozen(const Pair& hybrid) {
  return hybrid.Of(kEdgeFrozen, hybrid.p[2] < 0 ? -hybrid.Sign() : hybrid.Sign());
}

TEST(Identity, HybridIsFrozenAtEnds) {
  const int ends = ForDrawn(kEdgeHybrid, 0, [](const Pair& pair) {
    if (pair.IsInterior()) return false;
    ExpectSameEnergy(pair, Frozen(pair));
    ExpectSameMatrix(pair, Frozen(pair), "analytic");
    return true;
  });
  EXPECT_GE(ends, 500);  // none of `active`
}

// Its length and the gradient of that are those of the unsigned one everywhere.
TEST(Identity, HybridHasTheCurvatureOfFrozen) {
  ForDrawn(kEdgeHybrid, 50, [](const Pair& pair) {
    ExpectSameMatrix(pair, Frozen(pair), "gauss_newton");
    return true;
  });
}

TEST(Identity, TheAnalyticFilterOfFrozenIsGaussNewtonOutsideContact) {
  int inside = 0;
  const int outside = ForDrawn(kEdgeFrozen, 0, [&](const Pair& pair) {
    const bool is_outside = pair.Length() > 0;
    EXPECT_EQ(pair.Filtered("analytic") == pair.Filtered("gauss_newton"), is_outside);
    inside += !is_outside;
    return is_outside;
  });
  EXPECT_GE(inside, 500);
  EXPECT_GE(outside, 500);
}

// Above its threshold. A gradient of the mollifier that is not quite 0 would show in every filter.
TEST(Identity, MollifiedIsUnsignedForEdgesThatCross) {
  ForDrawn(kEdgeUnsigned, 50, [](const Pair& pair) {
    const Pair mollified = {kEdgeMollified, pair.x, {pair.p[0], pair.p[1], pair.p[2], 1e-60}};
    ExpectSameEnergy(pair, mollified);
    for (const char* filter : {"analytic", "absolute", "nearest"}) {
      ExpectSameMatrix(pair, mollified, filter);
    }
    return true;
  });
}

// A frame row rounds in units of all that it adds up, which is what absolute values add up to.
TEST(Identity, FiltersThroughTheFrameAreTheirNamesakes) {
  for (const EnergyRow& energy : AllEnergies()) {
    if (!FindKernel(energy.name + "/numeric_frame/f64")) continue;
    // A barrier has no pairs on the other side; two vertices are seldom near.
    const int least = energy.name.ends_with("log_barrier") ? 0
                      : energy.stencil == "vertex_vertex"  ? 15
                                                           : 50;
    ForDrawn(energy.name, least, [](const Pair& pair) {
      const double scale = FrobeniusNorm(pair.Filtered("absolute"));
      for (const auto& [frame, filter] : {std::pair("numeric_frame", "analytic"),
                                          {"analytic_frame", "analytic"},
                                          {"gauss_newton_frame", "gauss_newton"}}) {
        if (!FindKernel(pair.energy + "/" + frame + "/f64")) continue;
        EXPECT_LE(Ratio(pair.Filtered(frame), pair.Filtered(filter), scale, pair.Conditioning()),
                  kRatioBound)
            << pair.energy << " " << frame;
      }
      return true;
    });
  }
}

}  // namespace
}  // namespace definite
