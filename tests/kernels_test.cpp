// The kernels' own bodies: over float128 against the reference, and at the edges of their domain.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <boost/multiprecision/float128.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "all_filters.hpp"
#include "benchmarks/hand_fused.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "kernels/energies/collision_mollified.hpp"
#include "kernels/energies/collision_signed.hpp"
#include "kernels/energies/strand_bend.hpp"
#include "reference/oracle.hpp"
#include "tests/test_energies.hpp"

namespace definite {
namespace {

using reference::Quad;
using SignedVertexFace = Collision<Signed<VertexFace>, Quadratic>;

constexpr const char* kSignedVertexFace = "collision/vertex_face/signed/quadratic";

std::vector<double> RunRow(const std::string& filter, const std::vector<double>& x,
                           const std::vector<double>& p) {
  const KernelRow* row = FindKernel(std::string(kSignedVertexFace) + "/" + filter);
  std::vector<double> out(static_cast<std::size_t>(row->outputs));
  RunOne(*row, x.data(), p.data(), out.data());
  return out;
}

// Vertex at height z over the corner (0.25, 0.25) of the unit triangle in the xy plane.
std::vector<double> Above(double z) { return {0.25, 0.25, z, 0, 0, 0, 1, 0, 0, 0, 1, 0}; }

template <int D>
Quad RelativeError(const PackedSym<Quad, D>& f, const reference::Matrix<Quad>& m) {
  Quad distance = 0, norm = 0;
  int k = 0;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j, ++k) {
      distance += (f.a[k] - m(i, j)) * (f.a[k] - m(i, j));
      norm += m(i, j) * m(i, j);
    }
  }
  return sqrt(distance / norm);
}

template <class E, class Check>
void ForDrawn(const std::string& distribution, int count, Check check) {
  static const EnergyRow energy = MakeEnergy<E>();  // be it built into the tables or not
  Batch batch(energy);
  batch.Draw(*FindDistribution(distribution), 7, 0, count);
  for (int i = 0; i < count; ++i) {
    Vec<Quad, E::kDofs> x;
    Vec<Quad, E::kParams> p;
    for (int k = 0; k < E::kDofs; ++k) x[k] = batch.X(i)[k];
    for (int k = 0; k < E::kParams; ++k) p[k] = batch.P(i)[k];
    reference::Truth<Quad> truth(*reference::FindEnergy<Quad>(E::Name()), batch.X(i), batch.P(i));
    if (truth.Active()) check(x, p, truth);
  }
}

// The formulas are those of the reference: in float128 only rounding is left, about 1e-34 / sin^2.
template <class F, class E = SignedVertexFace>
void ExpectDefined(const std::string& distribution) {
  const auto* definition = reference::FindFilter<Quad>(F::kName);
  int checked = 0;
  ForDrawn<E>(distribution, 40, [&](const auto& x, const auto& p, auto& truth) {
    PackedSym<Quad, E::kDofs> f;
    ForPacked(F::template Apply<E>(x, p), [&f](int k, const Quad& value) { f.a[k] = value; });
    EXPECT_LT(RelativeError(f, definition->define(truth)), 1e-28) << F::kName;
    ++checked;
  });
  EXPECT_GE(checked, 20);
}

TEST(SignedVertexFace, HasTheReferencesHessianInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) ExpectDefined<None>(d);
}
TEST(SignedVertexFace, IsClampedInTheFrameInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) ExpectDefined<Analytic>(d);
}
TEST(SignedVertexFace, IsClampedAlikeByThePrintedFormulasInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) ExpectDefined<AnalyticPrinted>(d);
}
TEST(SignedVertexFace, HasTheReferencesCurvatureInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) ExpectDefined<GaussNewton>(d);
}

TEST(SignedVertexFace, IsProjectedInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) ExpectDefined<Nearest>(d);
}

template <class... F>
void ExpectAllDefined() {
  for (const char* d : {"paper", "active"}) (ExpectDefined<F>(d), ...);
}
TEST(SignedVertexFace, IsProjectedByEachEigensolverInFloat128) {
  ExpectAllDefined<Ql12, Ql9, Ql5, Jacobi12, Jacobi9, Jacobi5>();
}
TEST(SignedVertexFace, IsShiftedAndCutIntoBlocksInFloat128) {
  ExpectAllDefined<ShiftDiagonal, ShiftGershgorin, VertexBlocks>();
}

TEST(SignedVertexFace, HasTheReferencesValueAndGradientInFloat128) {
  ForDrawn<SignedVertexFace>("active", 40, [](const auto& x, const auto& p, auto& truth) {
    EXPECT_LT(abs(SignedVertexFace::Value(x, p) - truth.Value()), 1e-32);
    const auto gradient = SignedVertexFace::Gradient(x, p);
    for (int k = 0; k < 12; ++k) EXPECT_LT(abs(gradient[k] - truth.Gradient()[k]), 1e-30);
  });
}

TEST(SignedVertexFace, HasANormalOppositeToTheCounterClockwiseOne) {
  const std::vector<double> x = Above(0.5), p = {1, 1, 0};
  double value;
  FindKernel(std::string(kSignedVertexFace) + "/none/f64")
      ->energy->value(x.data(), p.data(), &value, 1);
  EXPECT_DOUBLE_EQ(value, 1.5 * 1.5);  // l = -0.5
}

TEST(SignedVertexFace, TakesItsSideFromTheParameter) {
  const EnergyRow* energy = FindKernel(std::string(kSignedVertexFace) + "/none/f64")->energy;
  const std::vector<double> x = Above(0.5);
  for (const auto& [side, l] : {std::pair(1., -0.5), {0., -0.5}, {-1., 0.5}}) {
    const std::vector<double> p = {1, 1, side};
    double value;
    energy->value(x.data(), p.data(), &value, 1);
    EXPECT_DOUBLE_EQ(value, (l - 1) * (l - 1)) << side;
  }
}

TEST(SignedVertexFace, IsZeroWhereInactive) {
  const std::vector<double> x = Above(-0.5), p = {1, 0.5, 0};  // l = eps
  for (const char* filter : {"none/f64", "analytic/f64", "gauss_newton/f64", "numeric/f64",
                             "analytic/f64x8", "none/f64x8", "gauss_newton/f64x8"}) {
    EXPECT_TRUE(AllZero(RunRow(filter, x, p))) << filter;
  }
}

TEST(SignedVertexFace, IsZeroAndCountedOutsideTheDomain) {
  const EnergyRow* energy = FindKernel(std::string(kSignedVertexFace) + "/none/f64")->energy;
  const std::vector<std::vector<double>> outside = {
      {0.2, 0.1, 0.3, 0, 0, 0, 1, 0, 0, 2, 0, 0},       // collinear
      {0.2, 0.1, 0.3, 0, 0, 0, 1, 0, 0, 2, 1e-9, 0},    // nearly
      {0.2, 0.1, 0.3, 1, 0, 0, 1, 0, 0, 0, 1, 0},       // an edge of length zero
      {0.2, 0.1, 0.3, 1, 0, 0, 1, 1e-200, 0, 0, 1, 0},  // an edge too short
      {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3},             // one point
  };
  const std::vector<double> p = {1, 10, 0};
  for (const std::vector<double>& x : outside) {
    double where[3];
    energy->classify(x.data(), p.data(), where, 1);
    EXPECT_EQ(where[0], 0);
    EXPECT_EQ(where[1], 0);
    for (const char* filter : {"none/f64", "analytic/f64", "gauss_newton/f64", "numeric/f64",
                               "analytic/f64x8", "none/f64x8", "gauss_newton/f64x8"}) {
      EXPECT_TRUE(AllZero(RunRow(filter, x, p))) << filter;
    }
  }
}

TEST(SignedVertexFace, PassesNaNOn) {
  for (std::size_t k = 0; k < 12; ++k) {
    std::vector<double> x = Above(0.01);
    x[k] = std::numeric_limits<double>::quiet_NaN();
    for (const char* filter : {"none/f64", "analytic/f64", "gauss_newton/f64", "numeric/f64",
                               "analytic/f64x8", "none/f64x8", "gauss_newton/f64x8"}) {
      EXPECT_FALSE(AllFinite(RunRow(filter, x, {1, 0.1, 0}))) << filter << " x" << k;
    }
  }
}

TEST(SignedVertexFace, WorksFromSubnormalToHugeLengths) {
  const std::vector<double> p = {1, 0.5, 0};
  const std::vector<double> x = {0.3, 0.2, 0.1, 0.9, 0.1, 0.2, 0.1, 0.3, 0.1, 0.2, 0.8, 0.4};
  const std::vector<double> expected = RunRow("analytic/f64", x, p);
  for (int exponent : {-1000, -900, -300, 300, 900, 1020}) {
    std::vector<double> scaled = x;
    for (double& v : scaled) v = std::ldexp(v, exponent);
    const std::vector<double> eps = {1, std::ldexp(0.5, exponent), 0};
    for (const char* filter : {"analytic/f64", "analytic/f64x8"}) {
      EXPECT_EQ(RunRow(filter, scaled, eps), expected) << exponent;
    }
  }
  // Subnormal coordinates keep few digits; the pair that they do give is filtered as well as ever.
  std::vector<double> tiny = x;
  for (double& v : tiny) v = std::ldexp(v, -1062);
  const std::vector<double> f = RunRow("analytic/f64", tiny, {1, std::ldexp(0.5, -1062), 0});
  EXPECT_TRUE(IsPsd(f));
  EXPECT_LT(RelativeDistance(f, expected), 0.1);
}

TEST(PrintedFormulas, GiveNaNAtZeroLengthAndTheDefaultDoesNot) {
  const std::vector<double> x = Above(0), p = {1, 0.1, 0};
  for (const char* scalar : {"/f64", "/f64x8"}) {
    for (double v : RunRow(std::string("analytic_printed") + scalar, x, p)) {
      EXPECT_TRUE(std::isnan(v) || v == 0);
    }
    EXPECT_FALSE(AllFinite(RunRow(std::string("analytic_printed") + scalar, x, p)));
    EXPECT_TRUE(AllFinite(RunRow(std::string("analytic") + scalar, x, p)));
    EXPECT_FALSE(AllZero(RunRow(std::string("analytic") + scalar, x, p)));
  }
}

TEST(HandFused, GivesTheBitsOfTheRow) {
  const KernelRow* row = FindKernel(std::string(kSignedVertexFace) + "/analytic/f64x8");
  Batch batch(*row->energy);
  batch.Draw(*FindDistribution("active"), 3, 0, 64);
  std::vector<double> by_hand(64 * 78), by_row(64 * 78);
  HandFusedAnalytic(batch.TilesX(8, 0), batch.TilesP(8, 0), by_hand.data(), 8);
  row->run(batch.TilesX(8, 0), batch.TilesP(8, 0), by_row.data(), 8);
  EXPECT_EQ(by_hand, by_row);
}

// An energy that lives in the tests: value, gradient and modes agree, by central differences.
template <class E>
void ExpectConsistent(const std::vector<double>& x0, const std::vector<double>& p0) {
  Vec<Quad, E::kDofs> x;
  Vec<Quad, E::kParams> p;
  for (int k = 0; k < E::kDofs; ++k) x[k] = x0[static_cast<std::size_t>(k)];
  for (int k = 0; k < E::kParams; ++k) p[k] = p0[static_cast<std::size_t>(k)];
  const Quad step = 1e-11;  // the error, step^2 and 1e-34/step, is then about 1e-22
  const auto gradient = E::Gradient(x, p);
  const auto hessian = ToPacked(None::Apply<E>(x, p));
  for (int j = 0; j < E::kDofs; ++j) {
    auto above = x, below = x;
    above[j] += step;
    below[j] -= step;
    EXPECT_LT(abs((E::Value(above, p) - E::Value(below, p)) / (2 * step) - gradient[j]), 1e-18);
    const auto g1 = E::Gradient(above, p), g0 = E::Gradient(below, p);
    for (int i = 0; i <= j; ++i) {
      const Quad h = hessian.a[i * E::kDofs - i * (i - 1) / 2 + j - i];
      EXPECT_LT(abs((g1[i] - g0[i]) / (2 * step) - h), 1e-18) << i << " " << j;
    }
  }
}

// Unlike those of a penalty of a length, the modes that the clamp is given may be negative.
TEST(StrandBend, IsClampedInTheFrameInFloat128) {
  ExpectDefined<Analytic, StrandBend>("normal");
  int negative = 0;
  ForDrawn<StrandBend>("normal", 40, [&](const auto& x, const auto& p, auto&) {
    const auto modes = StrandBend::HessianModes<Set::kFrame, Part::kPositive>(x, p);
    negative += std::ranges::any_of(modes.lambda, [](const Quad& v) { return v < 0; });
  });
  EXPECT_EQ(negative, 40);
}

TEST(StrandBend, HasTheReferencesHessianAndCurvatureInFloat128) {
  ExpectDefined<None, StrandBend>("normal");
  ExpectDefined<GaussNewton, StrandBend>("normal");
}

TEST(MollifiedEdges, HaveTheReferencesHessianInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) {
    ExpectDefined<None, CollisionMollified<Quadratic>>(d);
  }
}
TEST(MollifiedEdges, AreClampedInTheFrameInFloat128) {
  for (const char* d : {"paper", "normal", "active"}) {
    ExpectDefined<Analytic, CollisionMollified<Quadratic>>(d);
  }
}

// No curvature term of their own: it would be zero for parallel edges, where the Hessian is not.
TEST(MollifiedEdges, OfferNeitherGaussNewtonNorSplit) {
  using Energy = CollisionMollified<Quadratic>;
  static_assert(EnergyOver<Energy, double> && !OffersCurvature<Energy, double>);
  static_assert(!FilterOver<GaussNewton, Energy, double>);
  static_assert(!FilterOver<GaussNewtonFrame, Energy, double>);
  static_assert(!FilterOver<Split, Energy, double>);
  static_assert(FilterOver<Analytic, Energy, Lanes<double, kNativeLanes>>);
}

TEST(Interface, HoldsAStrandBendingEnergy) {
  static_assert(EnergyOver<StrandBend, double>);
  static_assert(EnergyOver<StrandBend, Lanes<double, kNativeLanes>>);
  static_assert(!OffersSet<StrandBend, double, Set::kPrinted>);
  ExpectConsistent<StrandBend>({0.3, 1.1, -0.2, 0, 0.1, 0.2, 1.2, -0.4, 0.5}, {2, 0.6});
  ExpectConsistent<StrandBend>({-1, 0.2, 0.1, 0, 0, 0, 1.2, 0.4, 0.5}, {1, 2.5});
}

TEST(Interface, HoldsATriangleWithACoupledScalingBlock) {
  static_assert(EnergyOver<testing::TriangleArap, double>);
  static_assert(EnergyOver<testing::TriangleArap, Lanes<double, kNativeLanes>>);
  ExpectConsistent<testing::TriangleArap>({0.1, 0.2, 1.3, 0.4, -0.2, 0.9}, {1.5, 0.7});
  ExpectConsistent<testing::TriangleArap>({0.1, 0.2, 0.5, 0.1, 0.2, 0.4}, {0, 1});
}

// Eigen 3.4 does not converge on the 12x12 Hessians of these configurations of `paper`, seed 42:
// the first of a g++ 12 build with AVX-512, the other of one with AVX2. Other builds round
// otherwise.
TEST(Numeric, HoldsWhereEigenDoesNotConverge) {
  const std::vector<std::vector<double>> configurations = {
      {0x1.4dae8ee36657cp-1, 0x1.6aaefd2b344c8p-3, 0x1.1a0e894d940ep-2, 0x1.b44aa116a9546p-1,
       0x1.ff364fef9ce85p-1, 0x1.c5eab93314322p-1, 0x1.1225671fa312ap-1, 0x1.eaa2ea4bca82bp-1,
       0x1.e8a1bc04de298p-1, 0x1.b67a23b8be972p-1, 0x1.aeccc7ba9e1cap-2, 0x1.8261642da974p-6},
      {0x1.3b16d10f43c9p-1, 0x1.0f85b41d66dep-4, 0x1.ce3bab5008324p-3, 0x1.057a747e12f63p-1,
       0x1.ebd45d53272e5p-1, 0x1.4e79d521556f9p-1, 0x1.9ed2d8381a914p-1, 0x1.4c7b7f54ad16bp-1,
       0x1.a101291696d72p-1, 0x1.ddad6b49a1d2p-3, 0x1.1527d95f1a48p-2, 0x1.207fc75a65274p-2}};
  const std::vector<double> p = {1, 1, 0};
  for (const std::vector<double>& x : configurations) {
    const auto outputs = [&](const std::string& filter) {
      const KernelRow* row =
          FindKernel("collision/edge_edge/unsigned_frozen/quadratic/" + filter + "/f64");
      std::vector<double> out(static_cast<std::size_t>(row->outputs));
      RunOne(*row, x.data(), p.data(), out.data());
      return out;
    };
    const std::vector<double> nearest = outputs("nearest");
    EXPECT_LT(FrobeniusDistance(outputs("numeric"), nearest),
              kRatioBound * 12 * kUnit * FrobeniusNorm(nearest));
    EXPECT_TRUE(std::isfinite(Eigenvalues(outputs("none")).front()));
  }
}

TEST(Scaling, ByAPowerOfTwoBringsANumberBetweenTwoAndFour) {
  for (double m : {0x1p-1022, 1e-300, 0.3, 1.0, 1.9999, 2.0, 1e300, 0x1.fffffp1023}) {
    for (double scaled :
         {m * InversePowerOfTwo(m), static_cast<double>(Quad(m) * InversePowerOfTwo(Quad(m)))}) {
      EXPECT_GE(scaled, 2);
      EXPECT_LT(scaled, 4);
    }
    double lanes[kNativeLanes];
    InversePowerOfTwo(Lanes<double, kNativeLanes>(m)).Store(lanes);
    for (double v : lanes) EXPECT_EQ(v, InversePowerOfTwo(m));
  }
}

TEST(Lanes, ComputeWhatScalarsDo) {
  using L = Lanes<double, kNativeLanes>;
  double a[kNativeLanes], b[kNativeLanes], out[kNativeLanes];
  for (int i = 0; i < kNativeLanes; ++i) {
    a[i] = 0.7 * i - 1.3;
    b[i] = 2.9 - 0.45 * i * i;
  }
  const L x = L::Load(a), y = L::Load(b);
  const auto expect = [&](const L& lanes, auto scalar) {
    lanes.Store(out);
    for (int i = 0; i < kNativeLanes; ++i) {
      const double expected = scalar(a[i], b[i]);
      EXPECT_TRUE(out[i] == expected || (std::isnan(out[i]) && std::isnan(expected)));
    }
  };
  expect(x + y, [](double p, double q) { return p + q; });
  expect(x - y, [](double p, double q) { return p - q; });
  expect(x * y, [](double p, double q) { return p * q; });
  expect(x / y, [](double p, double q) { return p / q; });
  expect(-x, [](double p, double) { return -p; });
  expect(Abs(x), [](double p, double) { return std::fabs(p); });
  expect(Sqrt(x), [](double p, double) { return std::sqrt(p); });
  expect(MulAdd(x, y, x), [](double p, double q) { return std::fma(p, q, p); });
  expect(Max(x, y), [](double p, double q) { return p > q ? p : q; });
  expect(Select(x < y, x, y), [](double p, double q) { return p < q ? p : q; });
  expect(Select((x <= y) | (x > L(0.0)), x, y),
         [](double p, double q) { return p <= q || p > 0 ? p : q; });
  expect(Select(x >= y, x, y), [](double p, double q) { return p >= q ? p : q; });
}

TEST(Lanes, TakeTheLargerOfNaNsAndZerosThatScalarsTake) {
  using L = Lanes<double, kNativeLanes>;
  const double values[] = {1.5,
                           -2.5,
                           0.0,
                           -0.0,
                           std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()};
  for (double p : values) {
    for (double q : values) {
      for (const auto& [lanes, scalar] :
           {std::pair(Max(L(p), L(q)), Max(p, q)), std::pair(Min(L(p), L(q)), Min(p, q))}) {
        double out[kNativeLanes];
        lanes.Store(out);
        for (double v : out) {
          EXPECT_EQ(std::bit_cast<std::uint64_t>(v), std::bit_cast<std::uint64_t>(scalar))
              << p << " and " << q;
        }
      }
    }
  }
}

TEST(Lanes, SayWhetherAConditionHoldsInAnyOfThem) {
  using L = Lanes<double, kNativeLanes>;
  double numbers[kNativeLanes] = {};
  EXPECT_FALSE(Any(L::Load(numbers) > L(0.0)));
  for (double& number : numbers) {
    number = 1;
    EXPECT_TRUE(Any(L::Load(numbers) > L(0.0)));
    number = 0;
  }
}

TEST(Pair, ComputesWhatItsHalvesWould) {
  using L = Lanes<double, kNativeLanes>;
  using P = Pair<L>;
  const double xs[] = {1.25, 7.5}, ys[] = {3.5, 0.75}, zs[] = {-0.5, 11};
  const P x{L(xs[0]), L(xs[1])}, y{L(ys[0]), L(ys[1])}, z{L(zs[0]), L(zs[1])};
  const auto expect = [&](const P& pair, auto scalar) {
    double out[2][kNativeLanes];
    pair.a.Store(out[0]);
    pair.b.Store(out[1]);
    for (int half : {0, 1}) {
      for (double v : out[half]) EXPECT_EQ(v, scalar(xs[half], ys[half], zs[half]));
    }
  };
  expect(x + y, [](double p, double q, double) { return p + q; });
  expect(x - y, [](double p, double q, double) { return p - q; });
  expect(x * y, [](double p, double q, double) { return p * q; });
  expect(x / y, [](double p, double q, double) { return p / q; });
  expect(-x, [](double p, double, double) { return -p; });
  expect(MulAdd(x, y, z), [](double p, double q, double r) { return std::fma(p, q, r); });
  expect(Sqrt(x), [](double p, double, double) { return std::sqrt(p); });
  expect(Abs(z), [](double, double, double r) { return std::fabs(r); });
  expect(Log(x), [](double p, double, double) { return Log(p); });
  expect(Log1p(x), [](double p, double, double) { return Log1p(p); });
  expect(Max(x, y), [](double p, double q, double) { return std::max(p, q); });
  expect(Min(x, y), [](double p, double q, double) { return std::min(p, q); });
  expect(InversePowerOfTwo(x), [](double p, double, double) { return InversePowerOfTwo(p); });
  expect(Select((x < y) | (z > P(10.0)), x, z),
         [](double p, double q, double r) { return p < q || r > 10 ? p : r; });
  expect(Select((x >= y) | (z <= P(-10.0)), x, z),
         [](double p, double q, double r) { return p >= q || r <= -10 ? p : r; });
  EXPECT_TRUE(Any(x < y));
  EXPECT_FALSE(Any(x < z - P(100.0)));
}

}  // namespace
}  // namespace definite
