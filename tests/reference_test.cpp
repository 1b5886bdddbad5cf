#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reference/closest_points.hpp"
#include "reference/oracle.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {
namespace {

template <class T>
const T kUnitRoundoff = std::numeric_limits<T>::epsilon() / 2;

// Uniform in [low, high), the same on every machine.
double Draw(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);
}

template <class T>
Matrix<T> Identity(int n) {
  Matrix<T> a(n, n);
  for (int i = 0; i < n; ++i) a(i, i) = T(1);
  return a;
}

template <class T>
Matrix<T> RandomSymmetric(std::mt19937_64& random, int n) {
  Matrix<T> a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) a(i, j) = a(j, i) = T(Draw(random, -1, 1));
  return a;
}

// |a - b| / |b|, and 0 if both are zero.
template <class T>
double Difference(const Matrix<T>& a, const Matrix<T>& b) {
  const T norm = FrobeniusNorm(a - b);
  return norm == 0 ? 0 : static_cast<double>(T(norm / FrobeniusNorm(b)));
}

template <class T>
bool AllEqual(const Matrix<T>& a, const T& value) {
  return std::all_of(a.entries.begin(), a.entries.end(), [&](const T& e) { return e == value; });
}

template <class T>
bool AllNaN(const Matrix<T>& a) {
  return std::all_of(a.entries.begin(), a.entries.end(), [](const T& e) { return e != e; });
}

// A row of `paper`: vertices iid in [0,1]^3. Active, and no needle (sine of the edge angle above
// 0.05), so that a test's tolerance need not carry the condition of the triangle.
template <class T>
struct Configuration {
  std::array<T, 12> x;
  std::array<T, 5> p;  // k, eps, side, and what the length and the penalty have of their own
};

Configuration<double> DrawActive(std::mt19937_64& random) {
  while (true) {
    Configuration<double> c;
    for (double& entry : c.x) entry = Draw(random, 0, 1);
    c.p = {Draw(random, 0.5, 2), Draw(random, 0.1, 1), Draw(random, -1, 1), 0, 0};
    const auto [e0, e1, e2] = VertexFace::EdgesOf(c.x.data());
    const Vec3<double> normal = Cross(e0, e1);
    const double l = Dot(normal, e2) / Norm(normal) * (c.p[2] < 0 ? -1 : 1);
    if (Norm(normal) > 0.05 * Norm(e0) * Norm(e1) && l < c.p[1]) return c;
  }
}

constexpr std::string_view kName = "collision/vertex_face/signed/quadratic";

template <class T>
Truth<T> TruthOf(const Configuration<double>& c) {
  return Truth<T>(*FindEnergy<T>(kName), c.x.data(), c.p.data());
}

// The sum of the terms of the frame, which is the Hessian.
Matrix<Quad> SumOfTerms(Truth<Quad>& truth) {
  Matrix<Quad> sum(truth.Of().dofs, truth.Of().dofs);
  for (const auto& [hessian, map] : truth.FrameTerms()) sum = sum + Congruence(hessian, map);
  return sum;
}

// S, which takes x to the frame coordinates.
template <class T>
const Matrix<T>& FrameMap(Truth<T>& truth) {
  return truth.FrameTerms()[0].map;
}

// Calls check(configuration) for `count` random active configurations.
template <class F>
void ForRandomConfigurations(int count, F check) {
  std::mt19937_64 random(20240611);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("configuration " + std::to_string(i));
    check(DrawActive(random));
  }
}

TEST(Matrix, MultipliesTransposesAndMeasures) {
  Matrix<double> a(2, 3);
  a.entries = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ((a * Transpose(a)).entries, (std::vector<double>{14, 32, 32, 77}));
  EXPECT_EQ((a + (a - a) + a).entries, (std::vector<double>{2, 4, 6, 8, 10, 12}));
  EXPECT_EQ(FrobeniusNorm(a), std::sqrt(91.0));
  EXPECT_EQ(Outer(2.0, Matrix<double>(a * Matrix<double>(3, 1, 1.0))).entries,
            (std::vector<double>{72, 180, 180, 450}));
}

TEST(Matrix, CongruenceIsTransposeTimesMatrixTimesFactor) {
  std::mt19937_64 random(1);
  const auto a = RandomSymmetric<double>(random, 3);
  Matrix<double> s(3, 5);
  for (double& entry : s.entries) entry = Draw(random, -1, 1);
  EXPECT_LT(Difference(Congruence(a, s), Transpose(s) * (a * s)), 1e-15);
}

// Central differences with step h err by h^2 f''' / 6 + u |f| / h: least near h = u^(1/3) = 5e-12,
// where both are about 1e-23. The Hessian is differenced from the gradient (itself checked against
// values): second differences of values could reach no better than u^(1/2) = 1e-17.
const Quad kStep = Quad(1) / (Quad(1 << 30) * Quad(1 << 7));  // 2^-37 = 7e-12

template <int N, class Value, class Exact>
void ExpectDerivativesMatchDifferences(Value value, Exact exact_at, const std::array<Quad, N>& x,
                                       double tolerance) {
  const Derivatives<Quad> exact = exact_at(x.data());
  Matrix<Quad> gradient(N, 1), hessian(N, N);
  for (int j = 0; j < N; ++j) {
    std::array<Quad, N> up = x, down = x;
    up.data()[j] += kStep;
    down.data()[j] -= kStep;
    gradient[j] = (value(up.data()) - value(down.data())) / (2 * kStep);
    const Matrix<Quad> rise = exact_at(up.data()).gradient - exact_at(down.data()).gradient;
    for (int i = 0; i < N; ++i) hessian(i, j) = rise[i] / (2 * kStep);
  }
  EXPECT_EQ(exact.value, value(x.data()));
  EXPECT_LT(Difference(exact.gradient, gradient), tolerance);
  EXPECT_LT(Difference(exact.hessian, hessian), tolerance);
}

TEST(Dual2, DifferentiatesEveryOperation) {
  for (const double y : {0.3, -0.7, 1.9, -2.5}) {
    for (const double x : {1.1, -0.8}) {
      SCOPED_TRACE(std::to_string(y) + ", " + std::to_string(x));
      const std::array<Quad, 2> at{Quad(y), Quad(x)};
      const auto check = [&](auto f) {
        const auto exact = [&](const Quad* v) { return Unpack(f(Variables<2>(v).data())); };
        ExpectDerivativesMatchDifferences<2>(f, exact, at, 1e-20);
      };
      check([](const auto* v) { return v[0] * v[0] * v[1] + 3 * v[0] - v[1] * 2.5; });
      check([](const auto* v) { return (1 + v[0] * v[0]) / (v[1] * v[0]); });
      check([](const auto* v) { return sqrt(v[0] * v[0] + 2 * v[1] * v[1]); });
      check([](const auto* v) { return log(v[0] * v[0] + v[1] * v[1] / 3); });
      check([](const auto* v) { return atan2(v[0], v[1]); });
      check([](const auto* v) { return -v[0] * v[1] - (v[0] - v[1]) * v[0]; });
    }
  }
}

TEST(Dual2, ComparesByValue) {
  const std::array<double, 2> x{1, 2};
  const auto v = Variables<2>(x.data());
  EXPECT_TRUE(v[0] < v[1] && v[1] >= v[0] && v[0] == 1 && v[0] < 1.5 && v[1] > 1);
  const Dual2<double, 2> nan(std::nan(""));
  EXPECT_FALSE(nan < v[0] || nan >= v[0] || nan == nan);
}

struct JacobiQuad {
  using Scalar = Quad;
  static Spectrum<Quad> Solve(const Matrix<Quad>& a) { return JacobiSpectrum(a); }
};
struct JacobiDouble {
  using Scalar = double;
  static Spectrum<double> Solve(const Matrix<double>& a) { return JacobiSpectrum(a); }
};
struct EigenQuad {
  using Scalar = Quad;
  static Spectrum<Quad> Solve(const Matrix<Quad>& a) { return EigenSpectrum(a); }
};
struct EigenDouble {
  using Scalar = double;
  static Spectrum<double> Solve(const Matrix<double>& a) { return EigenSpectrum(a); }
};

// Everything that makes a spectrum one, as test ratios: errors over n u |a|.
template <class Solver, class T = typename Solver::Scalar>
Spectrum<T> SolveAndExpectASpectrum(const Matrix<T>& a) {
  const int n = a.rows;
  const T bound = 10 * n * kUnitRoundoff<T>;
  const Spectrum<T> s = Solver::Solve(a);
  Matrix<T> scaled = s.vectors;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) scaled(i, j) *= s.values[j];
  EXPECT_LE(FrobeniusNorm(a * s.vectors - scaled), bound * FrobeniusNorm(a)) << "residual";
  EXPECT_LE(FrobeniusNorm(Transpose(s.vectors) * s.vectors - Identity<T>(n)), bound)
      << "orthogonality";
  EXPECT_LE(FrobeniusNorm(MapSpectrum(s, [](const T& lambda) { return lambda; }) - a),
            bound * FrobeniusNorm(a))
      << "reconstruction";
  EXPECT_TRUE(std::is_sorted(s.values.entries.begin(), s.values.entries.end()));
  return s;
}

template <class Solver>
class SpectrumTest : public testing::Test {};
using Solvers = testing::Types<JacobiQuad, JacobiDouble, EigenDouble, EigenQuad>;
TYPED_TEST_SUITE(SpectrumTest, Solvers);

TYPED_TEST(SpectrumTest, SolvesRandomMatrices) {
  std::mt19937_64 random(2);
  for (const int n : {1, 2, 3, 9, 12})
    for (int i = 0; i < 5; ++i)
      SolveAndExpectASpectrum<TypeParam>(RandomSymmetric<typename TypeParam::Scalar>(random, n));
}

TYPED_TEST(SpectrumTest, SolvesTheZeroMatrix) {
  using T = typename TypeParam::Scalar;
  EXPECT_TRUE(AllEqual(SolveAndExpectASpectrum<TypeParam>(Matrix<T>(12, 12)).values, T(0)));
}

TYPED_TEST(SpectrumTest, SolvesRankOne) {
  using T = typename TypeParam::Scalar;
  Matrix<T> v(12, 1);
  for (int i = 0; i < 12; ++i) v[i] = T(i - 4);
  const Spectrum<T> s = SolveAndExpectASpectrum<TypeParam>(Outer(T(-3), v));
  EXPECT_LE(abs(s.values[0] + 3 * 170), T(5000) * kUnitRoundoff<T>);
  EXPECT_LE(abs(s.values[11]), T(5000) * kUnitRoundoff<T>);
}

TYPED_TEST(SpectrumTest, SolvesRepeatedEigenvalues) {
  using T = typename TypeParam::Scalar;
  std::mt19937_64 random(3);
  const Matrix<T> basis = TypeParam::Solve(RandomSymmetric<T>(random, 12)).vectors;
  Matrix<T> a(12, 12);
  for (int i = 0; i < 12; ++i) a(i, i) = T(i < 7 ? 0 : i < 9 ? -2 : 5);
  const Spectrum<T> s = SolveAndExpectASpectrum<TypeParam>(Congruence(a, basis));
  EXPECT_LE(abs(s.values[0] + 2) + abs(s.values[1] + 2) + abs(s.values[2]) + abs(s.values[8]) +
                abs(s.values[9] - 5) + abs(s.values[11] - 5),
            T(1000) * kUnitRoundoff<T>);
  SolveAndExpectASpectrum<TypeParam>(Identity<T>(12));
}

TEST(EigenvaluesOf, AreThoseOfTheSpectrum) {
  std::mt19937_64 random(5);
  for (const int n : {1, 6, 9, 12}) {
    Matrix<double> a = RandomSymmetric<double>(random, n);
    for (int i = 0; i < 3; ++i, a = Outer(2.0, a * Matrix<double>(n, 1, 1))) {  // of rank one too
      const Matrix<double> values = EigenvaluesOf(a);
      EXPECT_LE(FrobeniusNorm(values - EigenSpectrum(a).values),
                10 * n * kUnitRoundoff<double> * FrobeniusNorm(a));
      EXPECT_TRUE(std::is_sorted(values.entries.begin(), values.entries.end()));
    }
  }
  EXPECT_TRUE(std::isnan(EigenvaluesOf(Matrix<double>(3, 3, std::nan("")))[0]));
}

TYPED_TEST(SpectrumTest, SolvesGradedMatrices) {
  using T = typename TypeParam::Scalar;
  std::mt19937_64 random(4);
  Matrix<T> a = RandomSymmetric<T>(random, 12);
  const auto grade = [](int i) { return T(std::pow(10.0, 5.5 * i - 30)); };  // 1e-30 .. 1e30.5
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) a(i, j) *= grade(i) * grade(j);
  SolveAndExpectASpectrum<TypeParam>(a);
}

TYPED_TEST(SpectrumTest, ReadsTheUpperTriangleOnly) {
  using T = typename TypeParam::Scalar;
  Matrix<T> a = Identity<T>(2);
  a(0, 1) = T(3);
  a(1, 0) = T(100);
  EXPECT_LE(abs(TypeParam::Solve(a).values[1] - 4), T(8) * kUnitRoundoff<T>);
}

TYPED_TEST(SpectrumTest, TurnsNonFiniteMatricesIntoNaN) {
  using T = typename TypeParam::Scalar;
  for (const T& bad : {std::numeric_limits<T>::quiet_NaN(), T(1) / T(0)}) {
    for (const auto& [i, j] : {std::pair(0, 0), std::pair(2, 5), std::pair(11, 11)}) {
      Matrix<T> a = Identity<T>(12);
      a(i, j) = a(j, i) = bad;
      const Spectrum<T> s = TypeParam::Solve(a);
      EXPECT_TRUE(AllNaN(s.values) && AllNaN(s.vectors));
      EXPECT_TRUE(AllNaN(NearestPsd(s)));
    }
  }
}

// [1e40 1; 1 4e-40] has determinant 3: its small eigenvalue is 3e-40 to full relative precision.
// A threshold of u |a| would skip the rotation and find 4e-40.
TEST(JacobiSpectrum, KeepsTheSmallEigenvaluesOfGradedMatrices) {
  const Quad big = pow(Quad(10), 40);
  Matrix<Quad> a(3, 3);
  a(0, 0) = 4 / big;
  a(0, 2) = a(2, 0) = Quad(1);
  a(1, 1) = Quad(1);
  a(2, 2) = big;
  const Spectrum<Quad> s = JacobiSpectrum(a);
  EXPECT_LT(abs(s.values[0] * big / 3 - 1), Quad(1e-32));
  EXPECT_LT(abs(s.values[1] - 1), Quad(1e-32));
}

TEST(NearestPsd, ClampsNegativeEigenvalues) {
  Matrix<double> a(2, 2);
  a.entries = {1, 2, 2, 1};  // 3 along (1, 1), -1 along (1, -1)
  Matrix<double> expected(2, 2, 1.5);
  EXPECT_LT(Difference(NearestPsd(SpectrumOf(a)), expected), 1e-15);
}

TEST(SignedVertexFace, MeasuresAgainstTheUsualNormal) {
  const Energy<double>& energy = *FindEnergy<double>(kName);
  const double x[] = {0.25, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto length = [&](double side) {
    const double p[] = {3, 0.5, side};
    return energy.length(x, p);
  };
  // The orientation trap: the vertex lies on the side of the usual normal.
  EXPECT_EQ(length(1), -1);
  EXPECT_EQ(length(0), -1);
  EXPECT_EQ(length(-1), 1);
  const double p[] = {3, 0.5, 1}, turned[] = {3, 0.5, -1};
  EXPECT_EQ(energy.value(x, p), 3 * 1.5 * 1.5);
  EXPECT_TRUE(energy.active(x, p));
  EXPECT_EQ(energy.value(x, turned), 0);
  EXPECT_FALSE(energy.active(x, turned));
}

TEST(SignedVertexFace, IgnoresTranslations) {
  Matrix<Quad> translations(12, 3);
  for (int i = 0; i < 12; ++i) translations(i, i % 3) = Quad(1);
  ForRandomConfigurations(20, [&](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    EXPECT_LT(FrobeniusNorm(truth.Hessian() * translations),
              Quad(1e-31) * FrobeniusNorm(truth.Hessian()));
    EXPECT_LT(FrobeniusNorm(FrameMap(truth) * translations), Quad(1e-31));
  });
}

// The terms of the frame sum to the Hessian for any weights; these are the Gram-Schmidt ones.
TEST(SignedVertexFace, FrameIsOrthogonalAndSpansTheEdges) {
  ForRandomConfigurations(20, [](const Configuration<double>& c) {
    Matrix<Quad> x(12, 1);
    std::copy(c.x.begin(), c.x.end(), x.entries.begin());
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Matrix<Quad> frame = FrameMap(truth) * x;
    const auto c0 = Block(&frame[0], 0), c1 = Block(&frame[0], 1), c2 = Block(&frame[0], 2);
    const auto [e0, e1, e2] = VertexFace::EdgesOf(&x[0]);
    EXPECT_LT(abs(Dot(c0, c1)) + abs(Dot(c0, c2)) + abs(Dot(c1, c2)), Quad(1e-30));
    EXPECT_LT(Norm(c0 - e0), Quad(1e-32));
    EXPECT_LT(Norm(Cross(c0, c1) - Cross(e0, e1)), Quad(1e-31));
    EXPECT_LT(abs(Dot(c2, Cross(e0, e1)) - Dot(e2, Cross(e0, e1))), Quad(1e-31));
  });
}

TEST(SignedVertexFace, NearestIsTheProjection) {
  ForRandomConfigurations(10, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Matrix<Quad>& nearest = truth.Nearest();
    const Matrix<Quad> removed = truth.Hessian() - nearest;
    const Quad tolerance = Quad(1e-30) * FrobeniusNorm(truth.Hessian());
    const Spectrum<Quad> spectrum = SpectrumOf(nearest);
    EXPECT_GT(spectrum.values[0], -tolerance);
    EXPECT_GT(spectrum.values[11], tolerance);
    EXPECT_LT(Difference(NearestPsd(spectrum), nearest), 1e-30) << "idempotent";
    EXPECT_LT(SpectrumOf(removed).values[11], tolerance) << "removes nothing positive";
    EXPECT_LT(FrobeniusNorm(nearest * removed), tolerance * FrobeniusNorm(nearest)) << "orthogonal";
  });
}

// psi'' = 2 k and psi' = 2 k (l - eps), so the curvature is g g^T / (2 psi) with g = grad psi.
TEST(SignedVertexFace, CurvatureIsTheGradientsOuterProduct) {
  ForRandomConfigurations(10, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Matrix<Quad> outer = Outer(Quad(1 / (2 * truth.Value())), truth.Gradient());
    EXPECT_LT(Difference(truth.Curvature(), outer), 1e-30);
    const Spectrum<Quad> spectrum = SpectrumOf(truth.Curvature());
    EXPECT_GT(spectrum.values[11], 0);
    EXPECT_LT(abs(spectrum.values[0]) + abs(spectrum.values[10]),
              Quad(1e-30) * spectrum.values[11]);
  });
}

// Powers of two scale exactly, and H = psi'' grad l grad l^T + psi' Hess l has no length unit.
TEST(SignedVertexFace, TakesEveryScaleOfDoublesInQuad) {
  ForRandomConfigurations(3, [](Configuration<double> c) {
    // Short coordinates, so that they stay exact even as subnormal doubles.
    for (double& entry : c.x) entry = std::round(entry * 1024) / 1024;
    c.p[1] = 0.75;
    Truth<Quad> truth = TruthOf<Quad>(c);
    for (const int exponent : {-1060, -1000, 1000}) {
      Configuration<double> scaled = c;
      for (double& entry : scaled.x) entry = std::ldexp(entry, exponent);
      scaled.p[1] = std::ldexp(c.p[1], exponent);
      Truth<Quad> far = TruthOf<Quad>(scaled);
      EXPECT_TRUE(far.Active());
      EXPECT_EQ(far.Hessian().entries, truth.Hessian().entries);
      EXPECT_EQ(far.Nearest().entries, truth.Nearest().entries);
      EXPECT_LT(Difference(SumOfTerms(far), far.Hessian()), 1e-28);
    }
  });
}

constexpr std::string_view kUnsignedVertexFace = "collision/vertex_face/unsigned/quadratic";
constexpr std::string_view kSigned = "collision/edge_edge/signed/quadratic";
constexpr std::string_view kUnsigned = "collision/edge_edge/unsigned/quadratic";
constexpr std::string_view kFrozen = "collision/edge_edge/unsigned_frozen/quadratic";
constexpr std::string_view kHybrid = "collision/edge_edge/hybrid/quadratic";
constexpr std::string_view kEdgeEdge[] = {kSigned, kUnsigned, kFrozen, kHybrid};

template <class T, class U>
Truth<T> TruthOf(std::string_view name, const Configuration<U>& c) {
  return Truth<T>(*FindEnergy<T>(name), c.x.data(), c.p.data());
}

template <class T>
Configuration<T> WithSide(Configuration<T> c, double side) {
  c.p[2] = T(side);
  return c;
}

// Calls check(configuration) for random active configurations of both sides and of neither.
template <class F>
void ForUnsignedVertexFaces(int count, F check) {
  ForRandomConfigurations(count, [&](const Configuration<double>& c) {
    for (const double side : {1.0, -1.0, 0.0}) {
      SCOPED_TRACE("side " + std::to_string(side));
      Configuration<double> active = WithSide(c, side);
      active.p[1] = 2;  // beyond every distance in the unit cube
      check(active);
    }
  });
}

template <class T>
T Triple(const Edges<T>& e) {
  return Dot(Cross(e.e0, e.e1), e.e2);
}

template <int N>
void ExpectDerivativesMatchDifferences(std::string_view name, const Configuration<Quad>& c) {
  const Energy<Quad>& energy = *FindEnergy<Quad>(name);
  std::array<Quad, N> x;
  std::copy_n(c.x.begin(), N, x.begin());
  ExpectDerivativesMatchDifferences<N>(
      [&](const Quad* at) { return energy.value(at, c.p.data()); },
      [&](const Quad* at) { return energy.derivatives(at, c.p.data()); }, x, 1e-18);
}

Configuration<Quad> ToQuad(const Configuration<double>& c) {
  Configuration<Quad> exact;
  std::copy(c.x.begin(), c.x.end(), exact.x.begin());
  std::copy(c.p.begin(), c.p.end(), exact.p.begin());
  return exact;
}

int CountBelow(const Spectrum<Quad>& spectrum, const Quad& bound) {
  const auto& values = spectrum.values.entries;
  return static_cast<int>(
      std::count_if(values.begin(), values.end(), [&](const Quad& v) { return v < bound; }));
}

TEST(UnsignedVertexFace, IsTheDistanceWithTheGivenSign) {
  const Energy<double>& energy = *FindEnergy<double>(kUnsignedVertexFace);
  const double below[] = {0.25, 0.25, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const double above[] = {7, -3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};  // the plane, not the triangle
  for (const auto& [side, at_below, at_above] :
       {std::array{1.0, 1.0, 1.0}, {-1.0, -1.0, -1.0}, {0.0, 1.0, -1.0}}) {
    const double p[] = {3, 0.5, side}, wide[] = {3, 1.5, side};
    EXPECT_EQ(energy.length(below, p), at_below);
    EXPECT_EQ(energy.length(above, p), at_above);
    EXPECT_EQ(energy.active(below, p), at_below < 0);
    EXPECT_EQ(energy.value(below, p), at_below < 0 ? 3 * 1.5 * 1.5 : 0);
    EXPECT_EQ(energy.value(below, wide), at_below < 0 ? 3 * 2.5 * 2.5 : 3 * 0.5 * 0.5);
  }
}

TEST(UnsignedVertexFace, IsTheSignedOneWhereTheSignsAgree) {
  ForUnsignedVertexFaces(10, [](const Configuration<double>& c) {
    const double triple = Triple(VertexFace::EdgesOf(c.x.data()));
    Truth<Quad> truth = TruthOf<Quad>(kUnsignedVertexFace, c);
    Truth<Quad> other = TruthOf<Quad>(WithSide(c, c.p[2] == 0 ? 0 : c.p[2] * triple));
    EXPECT_EQ(truth.Value(), other.Value());
    EXPECT_LT(Difference(truth.Gradient(), other.Gradient()), 1e-30);
    EXPECT_LT(Difference(truth.Hessian(), other.Hessian()), 1e-30);
    EXPECT_LT(Difference(truth.Curvature(), other.Curvature()), 1e-30);
  });
}

// Shi & Kim 2023, Eq. 17, with the Hessian of psi(|c2|) and D, the Jacobian of the frame less S.
TEST(UnsignedVertexFace, AnalyticFilterClampsTheFrameAndItsRemainder) {
  ForUnsignedVertexFaces(7, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(kUnsignedVertexFace, c);
    const Configuration<Quad> exact = ToQuad(c);
    const auto free = FrozenFrame<VertexFace>(Variables<12>(exact.x.data()).data(),
                                              Variables<12>(exact.x.data()).data());
    const Matrix<Quad>& s = FrameMap(truth);
    const Matrix<Quad> d = Jacobian(free) - s;
    const auto at = Values<9>(free.data());
    const Quad l = truth.Of().length(exact.x.data(), exact.p.data());
    const auto u = Norm(Block(Variables<9>(at.data()).data(), 2));
    const auto hessian = Unpack(Quadratic::Value(l < 0 ? -u : u, exact.p.data(), &l)).hessian;
    EXPECT_LT(Difference(Congruence(hessian, s) - Congruence(hessian, d), truth.Hessian()), 1e-28);
    EXPECT_GT(Difference(Congruence(hessian, s), truth.Hessian()), 1e-3);

    const Matrix<Quad> positive = NearestPsd(SpectrumOf(hessian));
    const Matrix<Quad> expected = Congruence(positive, s) - Congruence(hessian - positive, d);
    const Matrix<Quad> filtered = FindFilter<Quad>("analytic")->define(truth);
    EXPECT_LT(Difference(filtered, expected), 1e-30);
    const Quad tolerance = Quad(1e-30) * FrobeniusNorm(filtered);
    EXPECT_EQ(CountBelow(SpectrumOf(filtered), -tolerance), 0);
    // It only adds: psi'/u on the plane from the first term outside, from the second inside.
    EXPECT_EQ(CountBelow(SpectrumOf(filtered - truth.Hessian()), -tolerance), 0);
  });
}

// Every collision energy of the table.
std::vector<std::string_view> CollisionNames() {
  std::vector<std::string_view> names;
  for (const Energy<Quad>& energy : AllEnergies<Quad>())
    if (energy.name.starts_with("collision/")) names.push_back(energy.name);
  return names;
}

bool Contains(std::string_view name, std::string_view part) {
  return name.find(part) != std::string_view::npos;
}

// With parameters for what the energy of that name has of its own.
template <class T>
Configuration<T> WithOwnParameters(std::string_view name, Configuration<T> c) {
  size_t next = 3;
  if (Contains(name, "/anisotropic/")) c.p.data()[next++] = T(0.75);
  if (Contains(name, "/mollified/")) c.p.data()[next++] = T(0.5);
  if (Contains(name, "/cubic")) c.p.data()[next] = T(0.125);
  return c;
}

// Not a penalty of a length, so it has no curvature.
bool Lacks(std::string_view energy, std::string_view filter) {
  return Contains(energy, "/mollified/") &&
         (filter.starts_with("gauss_newton") || filter == "split");
}

enum class Region { kInside, kEndOfB, kEndOfA, kEnds };

// Two edges, constructed from their closest points x0 + a e0 and x2 + b e1.
struct EdgePair : Configuration<Quad> {
  Region region;
  Quad a, b;
  Vec3<Quad> between;  // the closest points
  Quad u;              // |between|, below eps

  Edges<Quad> Edge() const { return EdgeEdge::EdgesOf(x.data()); }
  Quad Sine() const {
    return Norm(Cross(Edge().e0, Edge().e1)) / Norm(Edge().e0) / Norm(Edge().e1);
  }
  // The sign of the signed length, and of the unsigned one.
  int Turn() const { return (Triple(Edge()) < 0) != (p[2] < 0) ? -1 : 1; }
  int Side() const { return p[2] < 0 ? -1 : p[2] > 0 ? 1 : Turn(); }
};

EdgePair DrawEdgePair(std::mt19937_64& random, Region region, double side) {
  const auto vector = [&] {
    const double x = Draw(random, -1, 1), y = Draw(random, -1, 1), z = Draw(random, -1, 1);
    return Vec3<Quad>{Quad(x), Quad(y), Quad(z)};
  };
  const auto normal_to = [](const Vec3<Quad>& v, const Vec3<Quad>& e) {
    return v - Dot(v, e) / Dot(e, e) * e;
  };
  const bool a_inside = region == Region::kInside || region == Region::kEndOfB;
  const bool b_inside = region == Region::kInside || region == Region::kEndOfA;
  EdgePair pair;
  while (true) {
    const Vec3<Quad> e0 = vector(), e1 = vector(), x0 = vector();
    Vec3<Quad> d = vector();
    if (a_inside) d = normal_to(d, e0);
    if (b_inside) d = normal_to(d, e1);
    if (region == Region::kInside) d = Dot(d, Cross(e0, e1)) < 0 ? Cross(e1, e0) : Cross(e0, e1);
    d = Quad(Draw(random, 0.1, 0.5)) / Norm(d) * d;
    pair.region = region;
    pair.a = Quad(a_inside ? Draw(random, 0.1, 0.9) : std::round(Draw(random, 0, 1)));
    pair.b = Quad(b_inside ? Draw(random, 0.1, 0.9) : std::round(Draw(random, 0, 1)));
    pair.between = d;
    pair.u = Norm(d);
    const Vec3<Quad> x2 = x0 + pair.a * e0 + d - pair.b * e1;
    const std::array vertices{x0, x0 + e0, x2, x2 + e1};
    for (size_t i = 0; i < 12; ++i) {
      const Vec3<Quad>& v = vertices.data()[i / 3];
      pair.x.data()[i] = i % 3 == 0 ? v.x : i % 3 == 1 ? v.y : v.z;
    }
    pair.p = {Quad(Draw(random, 0.5, 2)), Quad(Draw(random, 0.6, 1)), Quad(side)};
    // At an end, the distance grows along the edge: that makes a convex function's minimum.
    const Quad along_a = (2 * pair.a - 1) * Dot(d, e0) / pair.u;
    const Quad along_b = (1 - 2 * pair.b) * Dot(d, e1) / pair.u;
    if ((a_inside || along_a > 0.1) && (b_inside || along_b > 0.1) && pair.Sine() > 0.1)
      return pair;
  }
}

template <class F>
void ForEdgePairs(int count, F check) {
  std::mt19937_64 random(20240612);
  for (const Region region : {Region::kInside, Region::kEndOfB, Region::kEndOfA, Region::kEnds}) {
    for (const double side : {1.0, -1.0, 0.0}) {
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE("region " + std::to_string(static_cast<int>(region)) + ", side " +
                     std::to_string(side) + ", pair " + std::to_string(i));
        check(DrawEdgePair(random, region, side));
      }
    }
  }
}

// Calls check(name, configuration) for every collision energy whose name starts like that, at
// configurations in its domain of which none is near the border of a region. Vertex-edge and
// vertex-vertex read the first entries of x.
template <class F>
void ForCollisions(std::string_view start, F check) {
  for (const std::string_view name : CollisionNames()) {
    if (!name.starts_with(start)) continue;
    SCOPED_TRACE(name);
    int seen = 0;
    const auto check_in_domain = [&](const Configuration<Quad>& c) {
      const Configuration<Quad> own = WithOwnParameters(name, c);
      if (!TruthOf<Quad>(name, own).InDomain()) return;
      ++seen;
      check(name, own);
    };
    if (name.starts_with(EdgeEdge::Name())) {
      ForEdgePairs(1, check_in_domain);
    } else {
      ForUnsignedVertexFaces(5,
                             [&](const Configuration<double>& c) { check_in_domain(ToQuad(c)); });
    }
    EXPECT_GE(seen, 4);
  }
}
template <class F>
void ForEveryCollision(F check) {
  ForCollisions("collision/", check);
}

TEST(Collisions, FrameTermsSumToTheHessian) {
  ForEveryCollision([](std::string_view name, const Configuration<Quad>& c) {
    Truth<Quad> truth = TruthOf<Quad>(name, c);
    EXPECT_LT(Difference(SumOfTerms(truth), truth.Hessian()), 1e-28);
    const bool splits =
        name.starts_with("collision/vertex_face/unsigned/") || Contains(name, "/anisotropic/");
    EXPECT_EQ(truth.FrameTerms().size(), splits ? 3u : 1u);
  });
}

// Frozen closest points have a test of their own.
TEST(Collisions, DerivativesMatchDifferences) {
  ForEveryCollision([](std::string_view name, const Configuration<Quad>& c) {
    if (Contains(name, "/unsigned_frozen/") || Contains(name, "/hybrid/")) return;
    switch (FindEnergy<Quad>(name)->dofs) {
      case 12:
        return ExpectDerivativesMatchDifferences<12>(name, c);
      case 9:
        return ExpectDerivativesMatchDifferences<9>(name, c);
      case 6:
        return ExpectDerivativesMatchDifferences<6>(name, c);
      default:
        FAIL() << "dofs";
    }
  });
}

TEST(ClosestPoints, AreThoseTheEdgesWereConstructedFrom) {
  ForEdgePairs(10, [](const EdgePair& pair) {
    const ClosestPoints<Quad> found = FindClosestPoints(pair.Edge());
    EXPECT_LT(abs(found.a - pair.a) + abs(found.b - pair.b), Quad(1e-30));
    EXPECT_EQ(found.a_inside, pair.region == Region::kInside || pair.region == Region::kEndOfB);
    EXPECT_EQ(found.b_inside, pair.region == Region::kInside || pair.region == Region::kEndOfA);
    EXPECT_LT(Norm(Between(pair.Edge(), found) - pair.between), Quad(1e-31));
  });
}

TEST(ClosestPoints, AreNearestByBruteForce) {
  std::mt19937_64 random(20240613);
  std::array<int, 4> seen{};
  for (int i = 0; i < 200; ++i) {
    std::array<double, 12> x;
    for (double& entry : x) entry = Draw(random, 0, 1);
    const auto [e0, e1, e2] = EdgeEdge::EdgesOf(x.data());
    const auto distance = [&, v0 = e0, v1 = e1, v2 = e2](double a, double b) {
      return Norm(v2 - a * v0 + b * v1);
    };
    // The best of 11 x 11 points in a square that closes in on it.
    double a = 0.5, b = 0.5;
    for (double half = 0.5; half > 1e-9; half *= 0.8) {
      const double centre_a = a, centre_b = b;
      for (int j = -5; j <= 5; ++j) {
        for (int k = -5; k <= 5; ++k) {
          const double new_a = std::clamp(centre_a + j * half / 5, 0.0, 1.0);
          const double new_b = std::clamp(centre_b + k * half / 5, 0.0, 1.0);
          if (distance(new_a, new_b) < distance(a, b)) a = new_a, b = new_b;
        }
      }
    }
    const double p[] = {1, 10, 1};
    for (const std::string_view name : {kUnsigned, kFrozen})
      EXPECT_NEAR(FindEnergy<double>(name)->length(x.data(), p), distance(a, b), 1e-12) << name;
    const auto points = FindClosestPoints(Edges<double>{e0, e1, e2});
    ++seen[static_cast<size_t>(2 * points.a_inside + points.b_inside)];
  }
  for (const int count : seen) EXPECT_GT(count, 10);
}

TEST(EdgeEdge, LengthsHaveTheSignsOfTheirSides) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    const auto length = [&](std::string_view name) {
      return FindEnergy<Quad>(name)->length(pair.x.data(), pair.p.data());
    };
    const Edges<Quad> e = pair.Edge();
    const Quad height = pair.Turn() * abs(Triple(e)) / Norm(Cross(e.e0, e.e1));
    EXPECT_LT(abs(length(kSigned) - height), Quad(1e-31));
    EXPECT_LT(abs(length(kUnsigned) - pair.Side() * pair.u), Quad(1e-31));
    EXPECT_LT(abs(length(kFrozen) - pair.Side() * pair.u), Quad(1e-31));
    EXPECT_LT(abs(length(kHybrid) - pair.Turn() * pair.u), Quad(1e-31));
  });
}

// Of k (s |sum_i w_i x_i| - eps)^2 with constant w.
TEST(EdgeEdge, FrozenDerivativesMatchDifferencesAtFrozenPoints) {
  ForEdgePairs(2, [](const EdgePair& pair) {
    const Quad w[] = {pair.a - 1, -pair.a, 1 - pair.b, pair.b};
    const auto check = [&](std::string_view name, int sign) {
      const auto psi = [&](const auto* x) {
        const auto along = [&](int i) {
          return w[0] * x[i] + w[1] * x[i + 3] + w[2] * x[i + 6] + w[3] * x[i + 9];
        };
        const auto u = sqrt(along(0) * along(0) + along(1) * along(1) + along(2) * along(2));
        return pair.p[0] * (sign * u - pair.p[1]) * (sign * u - pair.p[1]);
      };
      const auto exact = [&](const Quad* x) { return Unpack(psi(Variables<12>(x).data())); };
      ExpectDerivativesMatchDifferences<12>(psi, exact, pair.x, 1e-18);
      Truth<Quad> truth = TruthOf<Quad, Quad>(name, pair);
      EXPECT_LT(abs(truth.Value() - exact(pair.x.data()).value), Quad(1e-31));
      EXPECT_LT(Difference(truth.Gradient(), exact(pair.x.data()).gradient), 1e-29);
      EXPECT_LT(Difference(truth.Hessian(), exact(pair.x.data()).hessian), 1e-29);
    };
    check(kFrozen, pair.Side());
    if (pair.region != Region::kInside) check(kHybrid, pair.Turn());
  });
}

// The closest points move without changing the distance, to first order (envelope theorem).
TEST(EdgeEdge, FrozenGradientIsTheGradient) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    Truth<Quad> frozen = TruthOf<Quad, Quad>(kFrozen, pair);
    Truth<Quad> exact = TruthOf<Quad, Quad>(kUnsigned, pair);
    EXPECT_LT(Difference(frozen.Gradient(), exact.Gradient()), 1e-29);
    EXPECT_LT(Difference(frozen.Curvature(), exact.Curvature()), 1e-29);
    if (pair.region == Region::kEnds)
      EXPECT_LT(Difference(frozen.Hessian(), exact.Hessian()), 1e-29);
    else
      EXPECT_GT(Difference(frozen.Hessian(), exact.Hessian()), 1e-3);
  });
}

TEST(EdgeEdge, UnsignedAndHybridAreTheSignedOneBetweenInsides) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    if (pair.region != Region::kInside) return;
    Truth<Quad> agreeing = TruthOf<Quad, Quad>(
        kSigned, WithSide<Quad>(pair, Triple(pair.Edge()) < 0 ? -pair.Side() : pair.Side()));
    Truth<Quad> truth = TruthOf<Quad, Quad>(kUnsigned, pair);
    EXPECT_LT(Difference(truth.Hessian(), agreeing.Hessian()), 1e-30);
    EXPECT_EQ((TruthOf<Quad, Quad>(kHybrid, pair).Hessian().entries),
              (TruthOf<Quad, Quad>(kSigned, pair).Hessian().entries));
  });
}

TEST(EdgeEdge, HybridIsTheFrozenOneAtEnds) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    if (pair.region == Region::kInside) return;
    Truth<Quad> frozen = TruthOf<Quad, Quad>(kFrozen, WithSide<Quad>(pair, pair.Turn()));
    EXPECT_EQ((TruthOf<Quad, Quad>(kHybrid, pair).Hessian().entries), frozen.Hessian().entries);
  });
}

TEST(EdgeEdge, HasTwoNegativeEigenvaluesOutsideContact) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    Truth<Quad> truth = TruthOf<Quad, Quad>(kUnsigned, pair);
    if (pair.Side() < 0) return;
    const Quad tolerance = Quad(1e-25) * FrobeniusNorm(truth.Hessian());
    EXPECT_EQ(CountBelow(truth.HessianSpectrum(), -tolerance), 2);
  });
}

// The terms of other frames sum to the Hessian too.
TEST(EdgeEdge, FrameHoldsTheVectorBetweenTheClosestPoints) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    const auto expect = [&](std::string_view name, const Vec3<Quad>& c0, const Vec3<Quad>& c1,
                            const Vec3<Quad>& c2) {
      Matrix<Quad> x(12, 1);
      std::copy(pair.x.begin(), pair.x.end(), x.entries.begin());
      Truth<Quad> truth = TruthOf<Quad, Quad>(name, pair);
      const Matrix<Quad> c = FrameMap(truth) * x;
      EXPECT_LT(Norm(Block(&c[0], 0) - c0), Quad(1e-31)) << name;
      EXPECT_LT(Norm(Block(&c[0], 1) - c1), Quad(1e-30)) << name;
      EXPECT_LT(Norm(Block(&c[0], 2) - c2), Quad(1e-30)) << name;
    };
    const auto [e0, e1, e2] = pair.Edge();
    const Vec3<Quad> zero{}, c1 = e1 - Dot(e1, e0) / Dot(e0, e0) * e0;
    const Vec3<Quad> n = Quad(1 / Norm(Cross(e0, e1))) * Cross(e0, e1);
    expect(kSigned, e0, c1, Dot(e2, n) * n);
    expect(kFrozen, zero, zero, pair.between);
    switch (pair.region) {
      case Region::kInside:
        expect(kUnsigned, e0, c1, pair.between);
        expect(kHybrid, e0, c1, pair.between);
        return;
      case Region::kEndOfB:
        expect(kUnsigned, e0, zero, pair.between);
        break;
      case Region::kEndOfA:
        expect(kUnsigned, e1, zero, zero - pair.between);
        break;
      case Region::kEnds:
        expect(kUnsigned, zero, zero, pair.between);
        break;
    }
    expect(kHybrid, zero, zero, pair.between);
  });
}

// The frame Hessian is psi'' n n^T + psi'/u (I - n n^T), and psi' < 0.
TEST(EdgeEdge, AnalyticFilterOfFrozenIsGaussNewtonOutsideContact) {
  ForEdgePairs(5, [](const EdgePair& pair) {
    Truth<Quad> truth = TruthOf<Quad, Quad>(kFrozen, pair);
    const Matrix<Quad> filtered = FindFilter<Quad>("analytic")->define(truth);
    if (pair.Side() > 0)
      EXPECT_LT(Difference(filtered, truth.Curvature()), 1e-29);
    else
      EXPECT_LT(Difference(filtered, truth.Hessian()), 1e-29);  // psi' > 0: already PSD
  });
}

TEST(EdgeEdge, IgnoresTheNumberingOfTheEdges) {
  using Numbering = std::array<int, 4>;
  const auto expect_same = [](std::string_view name, const EdgePair& pair,
                              const Numbering& numbering, double side) {
    Configuration<Quad> other = WithSide<Quad>(pair, side);
    const auto entry = [&](int i) { return 3 * numbering.data()[i / 3] + i % 3; };
    for (int i = 0; i < 12; ++i) other.x.data()[i] = pair.x.data()[entry(i)];
    Truth<Quad> truth = TruthOf<Quad, Quad>(name, pair), same = TruthOf<Quad>(name, other);
    Matrix<Quad> expected(12, 12);
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) expected(i, j) = truth.Hessian()(entry(i), entry(j));
    EXPECT_LT(abs(same.Value() - truth.Value()), Quad(1e-30)) << name;
    EXPECT_LT(Difference(same.Hessian(), expected), 1e-28) << name;
  };
  ForEdgePairs(2, [&](const EdgePair& pair) {
    const double side = static_cast<double>(pair.p[2]);
    for (const std::string_view name : kEdgeEdge) {
      expect_same(name, pair, {2, 3, 0, 1}, side);
      expect_same(name, pair, {1, 0, 3, 2}, side);
    }
    if (side == 0) return;
    for (const Numbering& one_reversed : {Numbering{1, 0, 2, 3}, {0, 1, 3, 2}}) {
      expect_same(kUnsigned, pair, one_reversed, side);
      expect_same(kFrozen, pair, one_reversed, side);
      expect_same(kSigned, pair, one_reversed, -side);
      expect_same(kHybrid, pair, one_reversed, -side);
    }
  });
}

TEST(EdgeEdge, IgnoresTranslations) {
  Matrix<Quad> translations(12, 3);
  for (int i = 0; i < 12; ++i) translations(i, i % 3) = Quad(1);
  ForEdgePairs(2, [&](const EdgePair& pair) {
    for (const std::string_view name : kEdgeEdge) {
      Truth<Quad> truth = TruthOf<Quad, Quad>(name, pair);
      EXPECT_LT(FrobeniusNorm(truth.Hessian() * translations),
                Quad(1e-30) * FrobeniusNorm(truth.Hessian()));
      EXPECT_LT(FrobeniusNorm(FrameMap(truth) * translations), Quad(1e-30));
    }
  });
}

// Unit edges: A along the x-axis from the origin, B along `direction` from `start`.
Configuration<double> UnitEdges(const Vec3<double>& start, const Vec3<double>& direction,
                                double side) {
  const Vec3<double> end = start + direction;
  return {{0, 0, 0, 1, 0, 0, start.x, start.y, start.z, end.x, end.y, end.z}, {3, 2, side}};
}
constexpr Vec3<double> kX{1, 0, 0}, kY{0, 1, 0};

TEST(EdgeEdge, MeasuresUnitEdgesAtRightAngles) {
  struct Case {
    Vec3<double> start;
    double height, distance;
    std::array<double, 4> w;
    Vec3<double> between;
  };
  const Case cases[] = {
      {{0.5, -0.25, 0.5}, 0.5, 0.5, {-0.5, -0.5, 0.75, 0.25}, {0, 0, 0.5}},
      {{0.5, -0.25, -0.5}, -0.5, 0.5, {-0.5, -0.5, 0.75, 0.25}, {0, 0, -0.5}},
      {{0.25, 0.75, 1}, 1, 1.25, {-0.75, -0.25, 1, 0}, {0, 0.75, 1}},         // x2 to A
      {{0.25, -1.75, -1}, -1, 1.25, {-0.75, -0.25, 0, 1}, {0, -0.75, -1}},    // x3 to A
      {{1.75, -0.25, 1}, 1, 1.25, {0, -1, 0.75, 0.25}, {0.75, 0, 1}},         // x1 to B
      {{-0.75, -0.25, 1}, 1, 1.25, {-1, 0, 0.75, 0.25}, {-0.75, 0, 1}},       // x0 to B
      {{1.375, 0.5, 1.5}, 1.5, 1.625, {0, -1, 1, 0}, {0.375, 0.5, 1.5}},      // x1 to x2
      {{-0.375, -1.5, 1.5}, 1.5, 1.625, {-1, 0, 0, 1}, {-0.375, -0.5, 1.5}},  // x0 to x3
      {{0.5, 0.25, 0}, 0, 0.25, {-0.5, -0.5, 1, 0}, {0, 0.25, 0}},            // in one plane
  };
  for (const Case& c : cases) {
    for (const double side : {1.0, -1.0, 0.0}) {
      SCOPED_TRACE(std::to_string(&c - cases) + ", side " + std::to_string(side));
      const auto expect = [&](std::string_view name, double length) {
        const Configuration<double> edges = UnitEdges(c.start, kY, side);
        const Energy<double>& energy = *FindEnergy<double>(name);
        EXPECT_EQ(energy.length(edges.x.data(), edges.p.data()), length) << name;
        Truth<double> truth = TruthOf<double>(name, edges);
        EXPECT_EQ(truth.Value(), 3 * (length - 2) * (length - 2)) << name;
        if (name == kSigned) return;
        const double slope = 2 * 3 * (length - 2) / length;
        const double between[] = {c.between.x, c.between.y, c.between.z};
        for (int i = 0; i < 12; ++i)
          EXPECT_NEAR(truth.Gradient()[i], slope * c.w.data()[i / 3] * between[i % 3], 1e-14)
              << name;
      };
      const double turn = side < 0 ? -1 : 1, triple = c.height < 0 ? -1 : 1;
      expect(kSigned, turn * c.height);
      expect(kUnsigned, side == 0 ? triple * c.distance : turn * c.distance);
      expect(kFrozen, side == 0 ? triple * c.distance : turn * c.distance);
      // 0 counts as positive even if turned.
      expect(kHybrid, c.height == 0 ? c.distance : turn * triple * c.distance);
    }
  }
}

TEST(EdgeEdge, MeasuresParallelEdges) {
  for (const auto& [start, distance] :
       {std::pair(Vec3<double>{0.25, 0.75, 1}, 1.25),
        std::pair(Vec3<double>{1.375, 0.5, 1.5}, 1.625), std::pair(Vec3<double>{1.5, 0, 0}, 0.5),
        // Slanted, the lines cross over the middle of both.
        std::pair(Vec3<double>{0, -0.45e-8, 1}, 1.0)}) {
    for (const double side : {1.0, -1.0, 0.0}) {
      for (const double direction : {1.0, -1.0}) {
        // Turned, B keeps its place; the second one is parallel within the threshold of the domain.
        const Vec3<double> from = direction < 0 ? start + kX : start;
        for (const double slant : {0.0, 0.9e-8}) {
          const auto edges = UnitEdges(from, direction * kX + slant * kY, side);
          EXPECT_FALSE(TruthOf<double>(kSigned, edges).InDomain());
          const auto expect = [&, d = distance](std::string_view name, double sign) {
            EXPECT_TRUE(TruthOf<double>(name, edges).InDomain()) << name;
            EXPECT_NEAR(FindEnergy<double>(name)->length(edges.x.data(), edges.p.data()), sign * d,
                        2e-8)
                << name;
          };
          expect(kUnsigned, side < 0 ? -1 : 1);
          expect(kFrozen, side < 0 ? -1 : 1);
          expect(kHybrid, 1);
        }
      }
    }
  }
}

TEST(EdgeEdge, TouchingIsOutsideTheDomainOfUnsignedLengths) {
  const auto crossing = UnitEdges({0.5, -0.5, 0}, kY, 1);
  for (const Configuration<double>& c :
       {crossing, UnitEdges({0.5, 0, 0}, kY, 1), UnitEdges({1, 0, 0}, kY, 1),
        UnitEdges({0.5, 0, 0}, kX, 1)}) {
    EXPECT_FALSE(TruthOf<Quad>(kUnsigned, c).InDomain());
    EXPECT_FALSE(TruthOf<Quad>(kFrozen, c).InDomain());
    EXPECT_EQ(TruthOf<Quad>(kHybrid, c).InDomain(), c.x == crossing.x);
  }
  Truth<Quad> signed_truth = TruthOf<Quad>(kSigned, crossing);
  EXPECT_EQ(TruthOf<Quad>(kHybrid, crossing).Hessian().entries, signed_truth.Hessian().entries);
  EXPECT_EQ(signed_truth.Value(), 3 * 2 * 2);
}

// psi at the length that the energy measures, with its slopes.
template <class P>
Dual2<Quad, 1> PsiOf(std::string_view name, const Configuration<Quad>& c) {
  const Energy<Quad>& energy = *FindEnergy<Quad>(name);
  const Quad l = energy.length(c.x.data(), c.p.data());
  const Quad* own = c.p.data() + energy.params - P::kParams;
  return P::Value(Variables<1>(&l)[0], c.p.data(), own);
}

// Calls check(penalty, name, configuration) for the energies of that length.
template <class F>
void ForPenaltiesOf(std::string_view length, F check) {
  ForCollisions(length, [&](std::string_view name, const Configuration<Quad>& c) {
    if (name.ends_with("/quadratic")) check(Quadratic{}, name, c);
    if (name.ends_with("/cubic")) check(Cubic{}, name, c);
    if (name.ends_with("/log_barrier")) check(LogBarrier{}, name, c);
  });
}

// Kronecker product of weights of the vertices and a vector.
Matrix<Quad> Kronecker(const std::vector<Quad>& w, const Vec3<Quad>& v) {
  Matrix<Quad> product(static_cast<int>(3 * w.size()), 1);
  const Quad entries[] = {v.x, v.y, v.z};
  for (int i = 0; i < product.rows; ++i) product[i] = w.data()[i / 3] * entries[i % 3];
  return product;
}

Matrix<Quad> Scaled(const Quad& factor, Matrix<Quad> a) {
  for (Quad& entry : a.entries) entry *= factor;
  return a;
}

TEST(Penalties, HaveTheSlopesOfTheirFormulas) {
  std::mt19937_64 random(20240614);
  for (int i = 0; i < 20; ++i) {
    const Quad p[] = {Quad(Draw(random, 0.5, 2)), Quad(Draw(random, 0.5, 2))};
    const Quad delta = Draw(random, 0, 1), &k = p[0], &eps = p[1];
    const Quad l = eps * Draw(random, 0.01, 1), d = l - eps;
    const auto expect = [&](auto penalty, const Quad& value, const Quad& psi1, const Quad& psi2) {
      const auto psi = penalty.Value(Variables<1>(&l)[0], p, &delta);
      EXPECT_LT(abs(psi.value / value - 1), Quad(1e-30)) << penalty.Name();
      EXPECT_LT(abs(psi.gradient[0] / psi1 - 1), Quad(1e-30)) << penalty.Name();
      EXPECT_LT(abs(psi.hessian[0] / psi2 - 1), Quad(1e-30)) << penalty.Name();
      EXPECT_TRUE(psi1 < 0 && psi2 > 0) << penalty.Name();
      const Quad beyond = 2 * eps;
      EXPECT_EQ(penalty.Value(eps, p, &delta), 0) << penalty.Name();
      EXPECT_EQ(penalty.Value(beyond, p, &delta), 0) << penalty.Name();
    };
    const Quad root = sqrt(d * d + delta), log_ratio = log(l / eps);
    expect(Quadratic{}, k * d * d, 2 * k * d, 2 * k);
    expect(Cubic{}, k * d * d * root, k * d * (3 * d * d + 2 * delta) / root,
           k * (6 * d * d * d * d + 9 * delta * d * d + 2 * delta * delta) / (root * root * root));
    expect(LogBarrier{}, -k * d * d * log_ratio, k * (-2 * d * log_ratio - d * d / l),
           k * ((eps - l) * (eps + 3 * l) / (l * l) - 2 * log_ratio));
  }
}

TEST(Penalties, KnowTheirDomain) {
  const auto in_domain = [](std::string_view name, const Configuration<double>& c) {
    const bool in = TruthOf<double>(name, c).InDomain();
    EXPECT_EQ(TruthOf<Quad>(name, c).InDomain(), in);
    return in;
  };
  const auto apart = [](double distance, double eps, double side) {
    return Configuration<double>{{0, 0, 0, distance}, {1, eps, side, 0}};
  };
  const std::string_view barrier = "collision/vertex_vertex/unsigned/log_barrier";
  EXPECT_TRUE(in_domain(barrier, apart(0.5, 1, 1)));
  EXPECT_TRUE(in_domain(barrier, apart(2, 1, 1)));
  EXPECT_FALSE(in_domain(barrier, apart(0.5, 1, -1)));
  EXPECT_TRUE(in_domain(barrier, apart(1.01e-150, 1, 1)));
  EXPECT_FALSE(in_domain(barrier, apart(0.99e-150, 1, 1)));
  EXPECT_TRUE(in_domain(barrier, apart(0.99e-150, 0.5, 1)));
  EXPECT_FALSE(in_domain(barrier, apart(0, 1, 1)));
  const std::string_view cubic = "collision/vertex_vertex/unsigned/cubic";
  Configuration<double> c = apart(0.5, 1, -1);
  EXPECT_TRUE(in_domain(cubic, c));  // delta = 0
  c.p[3] = -1e-3;
  EXPECT_FALSE(in_domain(cubic, c));

  // A vertex below the triangle's usual normal has l = 1.
  const Configuration<double> below{{0.25, 0.25, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 2, 1}};
  EXPECT_TRUE(in_domain("collision/vertex_face/signed/log_barrier", below));
  EXPECT_FALSE(in_domain("collision/vertex_face/signed/log_barrier", WithSide(below, -1)));
  EXPECT_TRUE(in_domain("collision/vertex_face/unsigned/log_barrier", WithSide(below, 0)));
}

TEST(Collisions, KnowTheDomainOfTheirOwnParameters) {
  const auto expect = [](std::string_view name, double parameter, bool in_domain) {
    Configuration<double> c{{0.25, 0.25, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 2, 1}};
    c.p[3] = parameter;
    EXPECT_EQ(TruthOf<Quad>(name, c).InDomain(), in_domain) << name << ", " << parameter;
  };
  for (const std::string_view name :
       {"collision/vertex_face/anisotropic/quadratic", "collision/edge_edge/anisotropic/cubic"}) {
    for (const double m : {0.5, 0.75, 1.0}) expect(name, m, true);
    for (const double m : {0.0, 0.4999, 1.0001, std::nan("")}) expect(name, m, false);
  }
  const std::string_view mollified = "collision/edge_edge/mollified/quadratic";
  for (const double threshold : {1e-300, 1.0, 1e300}) expect(mollified, threshold, true);
  for (const double threshold : {0.0, -1.0, std::nan("")}) expect(mollified, threshold, false);
}

// Sylvester's law: psi'' > 0 and psi' != 0.
TEST(Collisions, SignedOnesHaveThreePositiveAndTwoNegativeEigenvalues) {
  for (const std::string_view length :
       {"collision/vertex_face/signed", "collision/edge_edge/signed"}) {
    ForCollisions(length, [](std::string_view name, const Configuration<Quad>& c) {
      Truth<Quad> truth = TruthOf<Quad>(name, c);
      const Quad tolerance = Quad(1e-25) * FrobeniusNorm(truth.Hessian());
      EXPECT_EQ(CountBelow(truth.HessianSpectrum(), -tolerance), 2);
      EXPECT_EQ(CountBelow(truth.HessianSpectrum(), tolerance), 9);
    });
  }
}

TEST(Collisions, KeepANaN) {
  for (const std::string_view name : CollisionNames()) {
    for (size_t i = 0; i < static_cast<size_t>(FindEnergy<double>(name)->dofs); ++i) {
      Configuration<double> c = WithOwnParameters(name, UnitEdges({0.5, 0.25, 0.5}, kY, 1));
      c.x.data()[i] = std::nan("");
      Truth<double> truth = TruthOf<double>(name, c);
      EXPECT_NE(truth.Value(), truth.Value()) << name << ", entry " << i;
    }
  }
}

TEST(VertexVertex, HasTheEigenvaluesOfADistance) {
  ForPenaltiesOf(
      "collision/vertex_vertex", [](auto p, std::string_view name, const Configuration<Quad>& c) {
        const auto psi = PsiOf<decltype(p)>(name, c);
        const Quad l = FindEnergy<Quad>(name)->length(c.x.data(), c.p.data());
        EXPECT_LT(abs(abs(l) - Norm(Block(c.x.data(), 1) - Block(c.x.data(), 0))), Quad(1e-32));
        EXPECT_EQ(l < 0, c.p[2] < 0);
        Matrix<Quad> expected(6, 1);
        expected[0] = 2 * psi.hessian[0];
        expected[1] = expected[2] = 2 * psi.gradient[0] / l;
        std::sort(expected.entries.begin(), expected.entries.end());
        Truth<Quad> truth = TruthOf<Quad>(name, c);
        EXPECT_LT(Difference(truth.HessianSpectrum().values, expected), 1e-30);
        // Clamping in the frame is the nearest.
        EXPECT_LT(Difference(FindFilter<Quad>("analytic")->define(truth), truth.Nearest()), 1e-29);
      });
}

TEST(VertexEdge, MeasuresToTheLine) {
  const Energy<double>& energy = *FindEnergy<double>("collision/vertex_edge/unsigned/quadratic");
  for (const double at : {0.25, 7.0, -3.0}) {
    const double x[] = {at, 3, 4, 0, 0, 0, 2, 0, 0};
    for (const auto& [side, length] : {std::pair(1.0, 5.0), std::pair(0.0, 5.0), {-1.0, -5.0}}) {
      const double p[] = {3, 6, side};
      EXPECT_EQ(energy.length(x, p), length);
      EXPECT_EQ(energy.value(x, p), 3 * (length - 6) * (length - 6));
      EXPECT_TRUE(energy.in_domain(x, p));
    }
  }
  const double on_line[] = {7, 0, 0, 0, 0, 0, 2, 0, 0}, no_edge[] = {7, 1, 0, 1, 0, 0, 1, 0, 0};
  const double p[] = {3, 6, 1};
  EXPECT_FALSE(energy.in_domain(on_line, p));
  EXPECT_FALSE(energy.in_domain(no_edge, p));
}

// w (x) m, across the edge and the distance, is decoupled; the other three eigenvalues are the
// roots of a cubic.
TEST(VertexEdge, HasOneEigenvalueAcrossAndThreeOfACubic) {
  ForPenaltiesOf("collision/vertex_edge", [](auto p, std::string_view name,
                                             const Configuration<Quad>& c) {
    const auto psi = PsiOf<decltype(p)>(name, c);
    const Quad side = c.p[2] < 0 ? -1 : 1, psi1 = side * psi.gradient[0], psi2 = psi.hessian[0];
    const auto [e, none, from] = VertexEdge::EdgesOf(c.x.data());
    const Quad a = Norm(e), be = Dot(from, e) / (a * a);
    const Vec3<Quad> r = from - be * e, m = Cross(e, r);
    const Quad u = Norm(r);
    EXPECT_LT(abs(u - side * FindEnergy<Quad>(name)->length(c.x.data(), c.p.data())), Quad(1e-30));

    Truth<Quad> truth = TruthOf<Quad>(name, c);
    const std::vector<Quad> w{1, be - 1, -be};
    const Quad w2 = 1 + (be - 1) * (be - 1) + be * be, across = psi1 * w2 / u;
    const Matrix<Quad> v = Kronecker(w, m);
    EXPECT_LT(Difference(truth.Hessian() * v, Scaled(across, v)), 1e-28);

    const Quad norm = FrobeniusNorm(truth.Hessian()), tolerance = Quad(1e-25) * norm;
    const Quad cap_a = -2 * psi1 * u / (a * a), cap_b2 = 2 * psi1 * psi1 * w2 / (a * a);
    int roots = 0;
    for (const Quad& mu : truth.HessianSpectrum().values.entries) {
      if (abs(mu) < tolerance || abs(mu - across) < tolerance) continue;
      ++roots;
      const Quad cubic = mu * mu * mu - (cap_a + psi2 * w2) * mu * mu -
                         (cap_b2 - 1.5 * psi2 * cap_a) * mu + 1.5 * psi2 * cap_b2;
      EXPECT_LT(abs(cubic), Quad(1e-28) * norm * norm * norm);
    }
    EXPECT_EQ(roots, 3);
    EXPECT_EQ(CountBelow(truth.HessianSpectrum(), -tolerance), side < 0 ? 1 : 2);
  });
}

// Between a point and an inside, and between two ends, edges do what the smaller stencils do.
TEST(EdgeEdge, UnsignedIsVertexEdgeOrVertexVertexAtEnds) {
  ForCollisions("collision/edge_edge/unsigned/", [](std::string_view name,
                                                    const Configuration<Quad>& c) {
    const auto points = FindClosestPoints(EdgeEdge::EdgesOf(c.x.data()));
    if (points.BothInside()) return;
    const int end_of_a = points.a == 0 ? 0 : 1, end_of_b = points.b == 0 ? 2 : 3;
    const std::vector<int> vertices = points.a_inside   ? std::vector{end_of_b, 0, 1}
                                      : points.b_inside ? std::vector{end_of_a, 2, 3}
                                                        : std::vector{end_of_a, end_of_b};
    const int n = static_cast<int>(3 * vertices.size());
    const auto entry = [&](int i) { return 3 * vertices.data()[i / 3] + i % 3; };
    const Quad l = FindEnergy<Quad>(name)->length(c.x.data(), c.p.data());
    Configuration<Quad> part = WithSide(c, l < 0 ? -1 : 1);
    for (int i = 0; i < n; ++i) part.x.data()[i] = c.x.data()[entry(i)];
    const std::string stencil = vertices.size() == 3 ? VertexEdge::Name() : VertexVertex::Name();
    const std::string penalty(name.substr(name.rfind('/')));
    Truth<Quad> small = TruthOf<Quad>(stencil + "/unsigned" + penalty, part);
    Truth<Quad> truth = TruthOf<Quad>(name, c);
    EXPECT_LT(abs(truth.Value() - small.Value()), Quad(1e-29) * small.Value());
    for (const Filter<Quad>& filter : AllFilters<Quad>()) {
      // A multiple of the identity reaches the other vertices too.
      if (filter.name.starts_with("shift_")) continue;
      const Matrix<Quad> whole = filter.define(small);
      Matrix<Quad> expected(12, 12);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) expected(entry(i), entry(j)) = whole(i, j);
      EXPECT_LT(Difference(filter.define(truth), expected), 1e-27) << filter.name;
    }
  });
}

constexpr std::string_view kAnisotropic[] = {"collision/vertex_face/anisotropic",
                                             "collision/edge_edge/anisotropic"};

// The energy of that name with its anisotropic length made signed, which takes no m.
Truth<Quad> SignedTruth(std::string_view name, Configuration<Quad> c) {
  std::string signed_name(name);
  signed_name.replace(signed_name.find("anisotropic"), 11, "signed");
  c.p[3] = c.p[4];
  return TruthOf<Quad>(signed_name, c);
}

TEST(Anisotropic, IsSignedForMOneAndForPositiveLengths) {
  for (const std::string_view length : kAnisotropic) {
    ForCollisions(length, [](std::string_view name, Configuration<Quad> c) {
      for (const double m : {0.5, 0.8, 1.0}) {
        c.p[3] = Quad(m);
        Truth<Quad> truth = TruthOf<Quad>(name, c), other = SignedTruth(name, c);
        const Quad l = other.Of().length(c.x.data(), c.p.data());
        const Quad h = truth.Of().length(c.x.data(), c.p.data());
        EXPECT_LT(abs(h - (l > 0 ? l : (2 * c.p[3] - 1) * l)), Quad(1e-32));
        if (l < 0 && m < 1) continue;
        EXPECT_LT(abs(truth.Value() - other.Value()), Quad(1e-31) * other.Value());
        EXPECT_LT(Difference(truth.Gradient(), other.Gradient()), 1e-30);
        EXPECT_LT(Difference(truth.Hessian(), other.Hessian()), 1e-30);
        EXPECT_LT(Difference(truth.Curvature(), other.Curvature()), 1e-30);
        if (m == 1) {
          for (const Filter<Quad>& filter : AllFilters<Quad>())
            EXPECT_LT(Difference(filter.define(truth), filter.define(other)), 1e-29) << filter.name;
        }
      }
    });
  }
}

// m = 1/2 forgets a penetration.
TEST(Anisotropic, HasNoForceInsideForMOneHalf) {
  for (const std::string_view length : kAnisotropic) {
    ForCollisions(length, [](std::string_view name, Configuration<Quad> c) {
      c.p[3] = Quad(0.5);
      Truth<Quad> truth = TruthOf<Quad>(name, c), other = SignedTruth(name, c);
      if (other.Of().length(c.x.data(), c.p.data()) > 0) return;
      EXPECT_TRUE(truth.Active());
      EXPECT_GT(truth.Value(), 0);
      EXPECT_TRUE(AllEqual(truth.Gradient(), Quad(0)));
    });
  }
}

// Shi & Kim 2023, Eq. 35. Erratum: its 2 Psi_lu lacks the sign of l.
TEST(Anisotropic, FrameTermsAreThePapersGroups) {
  for (const std::string_view length : kAnisotropic) {
    ForPenaltiesOf(length, [](auto p, std::string_view name, Configuration<Quad> c) {
      for (const double m : {0.5, 0.8, 1.0}) {
        c.p[3] = Quad(m);
        Truth<Quad> truth = TruthOf<Quad>(name, c);
        Matrix<Quad> x(12, 1);
        std::copy(c.x.begin(), c.x.end(), x.entries.begin());
        const Matrix<Quad> at = FrameMap(truth) * x;
        const auto v = Variables<9>(&at[0]);
        const auto l = Unpack(OnSide(AlongNormal(FrameEdges(v.data())), c.p[2]));
        const auto u = Unpack(Norm(Block(v.data(), 2)));
        const auto psi = PsiOf<decltype(p)>(name, c);
        const Quad &m1 = c.p[3], sign = l.value < 0 ? -1 : 1, h_by_l = m1 + sign * (1 - m1);
        const auto& terms = truth.FrameTerms();
        ASSERT_EQ(terms.size(), 3u);
        const Matrix<Quad> first = Outer(Quad(psi.hessian[0] * h_by_l * h_by_l), l.gradient) +
                                   Scaled(m1 * psi.gradient[0], l.hessian);
        const Matrix<Quad> second = Scaled((1 - m1) * psi.gradient[0], u.hessian);
        EXPECT_LT(Difference(terms[0].hessian, first), 1e-28);
        EXPECT_LT(Difference(terms[1].hessian, second), 1e-28);
        EXPECT_EQ(terms[2].hessian.entries, (-terms[1].hessian).entries);
        EXPECT_EQ(terms[0].map.entries, terms[1].map.entries);
      }
    });
  }
}

// p with this threshold.
EdgePair WithThreshold(EdgePair pair, const Quad& threshold) {
  pair.p[3] = threshold;
  return pair;
}

Quad SquaredCross(const Edges<Quad>& e) { return Dot(Cross(e.e0, e.e1), Cross(e.e0, e.e1)); }

constexpr std::string_view kMollified = "collision/edge_edge/mollified/quadratic";

TEST(Mollified, IsUnsignedAboveTheThresholdAndAPartOfItBelow) {
  ForEdgePairs(3, [](const EdgePair& pair) {
    const Quad c = SquaredCross(pair.Edge());
    Truth<Quad> plain = TruthOf<Quad, Quad>(kUnsigned, pair);
    Truth<Quad> above = TruthOf<Quad, Quad>(kMollified, WithThreshold(pair, c * Quad(0.99)));
    EXPECT_EQ(above.Value(), plain.Value());
    EXPECT_EQ(above.Gradient().entries, plain.Gradient().entries);
    EXPECT_EQ(above.Hessian().entries, plain.Hessian().entries);
    for (const double part : {0.01, 0.5, 0.99}) {
      Truth<Quad> below = TruthOf<Quad, Quad>(kMollified, WithThreshold(pair, c / Quad(part)));
      EXPECT_LT(abs(below.Value() - (2 - Quad(part)) * part * plain.Value()), Quad(1e-30));
      EXPECT_GT(Difference(below.Hessian(), plain.Hessian()), 1e-3);
    }
    EXPECT_THROW(above.Curvature(), std::logic_error);
  });
}

// Four 2x2 blocks and a scalar, on strains and turns of an orthogonal frame.
TEST(Mollified, FrameHessianHasBlocksBetweenInsides) {
  ForEdgePairs(5, [](const EdgePair& drawn) {
    if (drawn.region != Region::kInside) return;
    for (const double part : {0.1, 0.9}) {
      const Quad c = SquaredCross(drawn.Edge());
      const EdgePair pair = WithThreshold(drawn, c / Quad(part));
      Truth<Quad> truth = TruthOf<Quad, Quad>(kMollified, pair);
      ASSERT_EQ(truth.FrameTerms().size(), 1u);
      const Matrix<Quad>& s = FrameMap(truth);
      Matrix<Quad> x(12, 1);
      std::copy(pair.x.begin(), pair.x.end(), x.entries.begin());
      const Matrix<Quad> frame = s * x;
      const Vec3<Quad> c0 = Block(&frame[0], 0), c1 = Block(&frame[0], 1);
      EXPECT_LT(Norm(c0 - pair.Edge().e0), Quad(1e-30));
      const Quad a = Norm(c0), b = Norm(c1);
      const Vec3<Quad> t0 = Quad(1 / a) * c0, t1 = Quad(1 / b) * c1, n = Cross(t0, t1);
      const Quad l = Dot(n, Block(&frame[0], 2)), sign = l < 0 ? -1 : 1;
      const auto& ex = pair.p[3];
      const Quad m = c / ex * (2 - c / ex), m1 = 2 * (1 - c / ex) / ex, m2 = -2 / (ex * ex);
      const Quad away = pair.Side() * abs(l) - pair.p[1];
      const Quad psi = pair.p[0] * away * away, psi1 = 2 * pair.p[0] * away * pair.Side() * sign;
      const Quad psi2 = 2 * pair.p[0];

      // v at slot i of the frame, as a functional.
      const auto at = [](int slot, const Quad& factor, const Vec3<Quad>& v) {
        std::vector<Quad> weights(3, Quad(0));
        weights.data()[slot] = factor;
        return Kronecker(weights, v);
      };
      const auto block = [](const Matrix<Quad>& u, const Matrix<Quad>& v, const Quad& uu,
                            const Quad& uv, const Quad& vv) {
        const Matrix<Quad> mixed = u * Transpose(v);
        return Outer(uu, u) + Scaled(uv, mixed + Transpose(mixed)) + Outer(vv, v);
      };
      const Quad root2 = sqrt(Quad(2)), zero(0);
      const auto x0 = at(0, 1 / a, t0), y1 = at(1, 1 / b, t1), z2 = at(2, 1, n);
      const Matrix<Quad> expected =
          block(at(0, 1, n), at(2, 1, t0), 2 * b * b * psi * m1 - m * psi1 * l / (a * a),
                -m * psi1 / a, zero) +
          block(at(1, 1, n), at(2, 1, t1), 2 * a * a * psi * m1 - m * psi1 * l / (b * b),
                -m * psi1 / b, zero) +
          block(at(1, 1, t0), at(0, 1, t1), zero, -2 * a * b * psi * m1, zero) +
          block(Scaled(1 / root2, x0 + y1), z2, psi * (6 * c * m1 + 8 * c * c * m2),
                2 * root2 * c * m1 * psi1, m * psi2) +
          Outer(Quad(-2 * c * m1 * psi), Scaled(1 / root2, x0 - y1));
      EXPECT_LT(Difference(truth.FrameTerms()[0].hessian, expected), 1e-28);
      const Quad tolerance = Quad(1e-25) * FrobeniusNorm(truth.Hessian());
      EXPECT_EQ(CountBelow(truth.HessianSpectrum(), -tolerance), 5);
      EXPECT_EQ(12 - CountBelow(truth.HessianSpectrum(), tolerance), 4);
    }
  });
}

// At ends: the edge that a point slides along, the other one normal to it, the vector between the
// points; and three groups of directions that know nothing of each other.
TEST(Mollified, FrameHessianHasBlocksAtEnds) {
  ForEdgePairs(3, [](const EdgePair& drawn) {
    if (drawn.region == Region::kInside) return;
    const EdgePair pair = WithThreshold(drawn, SquaredCross(drawn.Edge()) / Quad(0.4));
    Truth<Quad> truth = TruthOf<Quad, Quad>(kMollified, pair);
    Matrix<Quad> x(12, 1);
    std::copy(pair.x.begin(), pair.x.end(), x.entries.begin());
    const Matrix<Quad> frame = FrameMap(truth) * x;
    const Vec3<Quad> c0 = Block(&frame[0], 0), c1 = Block(&frame[0], 1), c2 = Block(&frame[0], 2);
    const Edges<Quad> e = pair.Edge();
    const bool starts_at_b = pair.region == Region::kEndOfA;
    EXPECT_LT(Norm(c0 - (starts_at_b ? e.e1 : e.e0)), Quad(1e-30));
    EXPECT_LT(abs(Norm(Cross(c0, c1)) - Norm(Cross(e.e0, e.e1))), Quad(1e-30));
    EXPECT_LT(abs(Dot(c0, c1)), Quad(1e-30));
    EXPECT_LT(Norm(c2 - pair.between), Quad(1e-30));
    EXPECT_TRUE(abs(Dot(c0, c2)) < Quad(1e-30) || pair.region == Region::kEnds);

    const auto unit = [](const Vec3<Quad>& v) { return Quad(1 / Norm(v)) * v; };
    const Vec3<Quad> t0 = unit(c0), t1 = unit(c1), normal = Cross(t0, t1), n = unit(c2);
    const Vec3<Quad> across = unit(Cross(c0, n)), along = Cross(across, n);
    const auto at = [](int slot, const Vec3<Quad>& v) {
      std::vector<Quad> weights(3, Quad(0));
      weights.data()[slot] = 1;
      return Kronecker(weights, v);
    };
    const std::vector<Matrix<Quad>> groups[] = {{at(0, t0), at(1, t1), at(2, n)},
                                                {at(0, t1), at(0, normal), at(1, t0), at(2, along)},
                                                {at(1, normal)},
                                                {at(2, across)}};
    const Matrix<Quad>& hessian = truth.FrameTerms()[0].hessian;
    const Quad tolerance = Quad(1e-28) * FrobeniusNorm(hessian);
    for (const auto& group : groups) {
      for (const auto& other : groups) {
        if (&group == &other) continue;
        for (const auto& u : group)
          for (const auto& v : other) EXPECT_LT(abs((Transpose(u) * (hessian * v))[0]), tolerance);
      }
    }
  });
}

// m = 0 and its gradient vanishes, but not its Hessian, 2 psi / ex Hess c.
TEST(Mollified, ParallelEdgesDoNotAct) {
  for (const Vec3<double>& start : {Vec3<double>{0.25, 0.75, 1}, {1.375, 0.5, 1.5}}) {
    for (const double side : {1.0, -1.0}) {
      Configuration<double> edges = UnitEdges(start, kX, side);
      edges.p[3] = 0.5;
      Truth<Quad> truth = TruthOf<Quad>(kMollified, edges);
      EXPECT_TRUE(truth.InDomain());
      EXPECT_TRUE(truth.Active());
      EXPECT_EQ(truth.Value(), 0);
      EXPECT_TRUE(AllEqual(truth.Gradient(), Quad(0)));
      const Configuration<Quad> exact = ToQuad(edges);
      const auto e = EdgeEdge::EdgesOf(Variables<12>(exact.x.data()).data());
      const auto cross = Cross(e.e0, e.e1);
      const Quad psi = TruthOf<Quad>(kUnsigned, edges).Value();
      EXPECT_LT(Difference(truth.Hessian(),
                           Scaled(2 * psi / exact.p[3], Unpack(Dot(cross, cross)).hessian)),
                1e-30);
      EXPECT_LT(Difference(truth.Nearest(), truth.Hessian()), 1e-30);
    }
  }
}

TEST(Split, AddsTheClampedGeometricTermToTheCurvature) {
  ForEveryCollision([](std::string_view name, const Configuration<Quad>& c) {
    if (Lacks(name, "split")) return;
    Truth<Quad> truth = TruthOf<Quad>(name, c);
    const Matrix<Quad> split = FindFilter<Quad>("split")->define(truth);
    const Quad tolerance = Quad(1e-30) * FrobeniusNorm(split);
    EXPECT_EQ(CountBelow(SpectrumOf(split), -tolerance), 0);
    EXPECT_EQ(CountBelow(SpectrumOf(split - truth.Curvature()), -tolerance), 0);
    EXPECT_EQ(CountBelow(SpectrumOf(split - truth.Hessian()), -tolerance), 0);
    // What it adds is the negative part of the geometric term.
    const auto negative = NearestPsd(SpectrumOf(truth.Curvature() - truth.Hessian()));
    EXPECT_LT(FrobeniusNorm(split - truth.Hessian() - negative), tolerance);
  });
}

// There w is orthogonal to the turns of the normal; elsewhere split is not the nearest.
TEST(Split, IsTheNearestAtTheCentroidAndBetweenTheMiddles) {
  std::mt19937_64 random(20240615);
  const auto distance = [](std::string_view name, const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(name, c);
    EXPECT_TRUE(truth.Active());
    return Difference(FindFilter<Quad>("split")->define(truth), truth.Nearest());
  };
  for (int i = 0; i < 10; ++i) {
    // Entries that are short, so that the centroid and the middle are exact.
    const auto draw = [&] { return std::round(Draw(random, -100, 100)) / 16; };
    Vec3<double> v[3];
    for (Vec3<double>& at : v) at = {3 * draw(), 3 * draw(), 3 * draw()};
    const Vec3<double> e0 = v[0] - v[1], e1 = v[2] - v[1];
    const Vec3<double> off = 1.0 / 1024 * Cross(e0, e1);
    const auto thirds = v[0] + v[1] + v[2];
    const Vec3<double> centroid{thirds.x / 3, thirds.y / 3, thirds.z / 3};
    const auto configuration = [&](const std::array<Vec3<double>, 4>& vertices) {
      Configuration<double> c{{}, {1, 1000, 1}};
      for (size_t j = 0; j < 4; ++j) {
        c.x.data()[3 * j] = vertices.data()[j].x;
        c.x.data()[3 * j + 1] = vertices.data()[j].y;
        c.x.data()[3 * j + 2] = vertices.data()[j].z;
      }
      return c;
    };
    EXPECT_LT(distance(kName, configuration({centroid + off, v[0], v[1], v[2]})), 1e-28);
    EXPECT_GT(distance(kName, configuration({v[0] + off, v[0], v[1], v[2]})), 1e-6);
    EXPECT_LT(distance(kSigned, configuration({e0, -1.0 * e0, e1 + off, off - e1})), 1e-28);
    EXPECT_GT(distance(kSigned, configuration({e0, 0.0 * e0, e1 + off, off - e1})), 1e-6);
  }
}

// A length is good to a roundoff of the longest edge: what matters is how far psi'' stays the same.
TEST(Energies, AreConditionedByTheMarginOfTheirPenalty) {
  const auto expect = [](std::string_view name, const Configuration<double>& c, double expected) {
    EXPECT_NEAR(FindEnergy<double>(name)->conditioning(c.x.data(), c.p.data()), expected, 1e-14)
        << name;
  };
  // u = l = 0.25 with the sine 0.8 and edges of length 1.
  Configuration<double> face{{0, 0, -0.25, 1, 0, 0, 0, 0, 0, 0.6, 0.8, 0}, {1, 1, 1, 0.01}};
  for (const std::string length :
       {"collision/vertex_face/signed", "collision/vertex_face/unsigned"}) {
    face.p[2] = length.ends_with("unsigned") ? 1 : -1;
    const double nearness = length.ends_with("unsigned") ? 0.25 : 1;
    for (const auto& [eps, barrier] : {std::pair(1.0, 0.25), std::pair(0.375, 0.125)}) {
      face.p[1] = eps;
      expect(length + "/log_barrier", face, 0.8 * barrier);
      expect(length + "/quadratic", face, 0.8 * nearness);
      expect(length + "/cubic", face,
             0.8 * std::min(nearness, std::hypot(eps - 0.25, std::sqrt(face.p[3]))));
    }
    face.p[1] = 0.25;  // inactive
    expect(length + "/log_barrier", face, 0.8 * nearness);
  }
  const auto inside = UnitEdges({0.25, -0.25, 0.5}, {0.6, 0.8, 0}, 1);
  const auto at_end = UnitEdges({0.25, 0.375, 0.5}, {0.6, 0.8, 0}, 1);  // u = 0.625
  for (const std::string length : {"unsigned", "unsigned_frozen", "hybrid", "mollified"}) {
    const std::string name = "collision/edge_edge/" + length + "/log_barrier";
    expect(name, WithOwnParameters(name, inside), 0.8 * 0.5);
    expect(name, WithOwnParameters(name, at_end), 0.625);
  }
  const auto mollified = [](Configuration<double> c, double threshold) {
    c.p[3] = threshold;
    return c;
  };
  const std::string name = "collision/edge_edge/mollified/quadratic";
  expect(name, mollified(inside, 0.5), 0.8);
  // At an end the angle counts as far as the mollifier does: 0.64 / ex.
  const auto sharp = UnitEdges({0.25, 0.375, 0.5}, {std::sqrt(0.9999), 0.01, 0}, 1);
  expect(name, mollified(sharp, 1), 0.625);
  expect(name, mollified(sharp, 2e-4), 0.625 * 0.01 / 0.5);
  expect(name, mollified(sharp, 0.9e-4), 0.625);
  const auto anisotropic = WithOwnParameters("/anisotropic/", inside);
  expect("collision/edge_edge/anisotropic/quadratic", anisotropic, 0.8 * 0.5);
  const Configuration<double> edge{{7, 3, 4, 0, 0, 0, 2, 0, 0}, {1, 6, 1}};
  expect("collision/vertex_edge/unsigned/quadratic", edge, 5 / std::sqrt(74));
  expect("collision/vertex_edge/unsigned/log_barrier", edge, 1 / std::sqrt(74));
  const Configuration<double> points{{0, 0, 0, 0, 4, 0}, {1, 5, 1}};
  expect("collision/vertex_vertex/unsigned/quadratic", points, 1);
  expect("collision/vertex_vertex/unsigned/log_barrier", points, 0.25);
}

// docs/protocol.md, section 1: the sine of the angle and the distance over the longest edge.
TEST(Energies, KnowTheirConditioning) {
  const auto conditioning = [](std::string_view name, const Configuration<double>& c) {
    return FindEnergy<double>(name)->conditioning(c.x.data(), c.p.data());
  };
  const auto expect = [&](const Configuration<double>& c, const std::array<double, 4>& expected) {
    for (size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(conditioning(kEdgeEdge[i], c), expected.data()[i], 1e-15) << kEdgeEdge[i];
  };
  const Vec3<double> oblique{0.6, 0.8, 0};
  expect(UnitEdges({0.25, -0.25, 0.5}, oblique, 1), {0.8, 0.8, 0.4, 0.8});
  expect(UnitEdges({0.25, 0.375, 0.5}, oblique, 1), {0.8, 0.625, 0.625, 0.625});  // x2 to A
  expect(UnitEdges({0, 0.75, 1}, oblique, 1), {0.8, 1, 1, 1});                    // |e2| = u = 1.25
  expect(UnitEdges({2.5, 0, 2}, kY, 1), {1, 2.5 / std::sqrt(10.25), 2.5 / std::sqrt(10.25),
                                         2.5 / std::sqrt(10.25)});  // |e2| > |e0|
  const double h = 0.25;
  const Configuration<double> face{{0, 0, h, 1, 0, 0, 0, 0, 0, 0.6, 0.8, 0}, {1, 1, 1}};
  EXPECT_NEAR(conditioning(kUnsignedVertexFace, face), 0.8 * h, 1e-15);
}

template <class T>
class TruthTest : public testing::Test {};
using Scalars = testing::Types<double, Quad>;
TYPED_TEST_SUITE(TruthTest, Scalars);

TYPED_TEST(TruthTest, IsZeroWhereInactive) {
  using T = TypeParam;
  ForRandomConfigurations(5, [](Configuration<double> c) {
    c.p[1] = -2;  // l >= eps everywhere in the unit cube
    Truth<T> truth = TruthOf<T>(c);
    EXPECT_TRUE(truth.InDomain());
    EXPECT_FALSE(truth.Active());
    EXPECT_EQ(truth.Value(), 0);
    EXPECT_TRUE(AllEqual(truth.Gradient(), T(0)));
    EXPECT_TRUE(AllEqual(truth.FrameTerms()[0].hessian, T(0)));
    EXPECT_TRUE(AllEqual(truth.HessianSpectrum().values, T(0)));
    for (const Filter<T>& filter : AllFilters<T>())
      EXPECT_TRUE(AllEqual(filter.define(truth), T(0))) << filter.name;
  });
}

TYPED_TEST(TruthTest, IsZeroWhereAnyCollisionIsInactive) {
  using T = TypeParam;
  for (const std::string_view name : CollisionNames()) {
    SCOPED_TRACE(name);
    int seen = 0;
    ForRandomConfigurations(10, [&](Configuration<double> c) {
      c.p[1] = -2;
      Truth<T> truth = TruthOf<T>(name, WithOwnParameters(name, c));
      EXPECT_TRUE(truth.InDomain() || name.ends_with("log_barrier"));
      if (!truth.InDomain()) return;
      ++seen;
      EXPECT_FALSE(truth.Active());
      EXPECT_EQ(truth.Value(), 0);
      EXPECT_GT(FrobeniusNorm(FrameMap(truth)), 0);
      for (const Filter<T>& filter : AllFilters<T>()) {
        if (Lacks(name, filter.name)) continue;
        EXPECT_TRUE(AllEqual(filter.define(truth), T(0))) << filter.name;
      }
    });
    EXPECT_GT(seen, 0);
  }
}

TYPED_TEST(TruthTest, IsInactiveAtTheActivationDistance) {
  using T = TypeParam;
  Configuration<double> c{{0.25, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {3, 1, -1}};  // l = 1 = eps
  EXPECT_FALSE(TruthOf<T>(c).Active());
  EXPECT_TRUE(AllEqual(TruthOf<T>(c).Hessian(), T(0)));
  c.p[1] = std::nextafter(1.0, 2.0);
  EXPECT_TRUE(TruthOf<T>(c).Active());
  EXPECT_FALSE(AllEqual(TruthOf<T>(c).Hessian(), T(0)));
}

TYPED_TEST(TruthTest, IsNaNOutsideTheDomain) {
  using T = TypeParam;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::array<double, 5> p{1, 2, 1};
  const Configuration<double> outside[] = {
      {{0, 0, 1, 1, 0, 0, 0, 0, 0, 2, 0, 0}, p},                    // e0 and e1 parallel
      {{0, 0, 1, 1, 0, 0, 0, 0, 0, std::sqrt(0.5), 0.7e-8, 0}, p},  // sine 0.99e-8
      {{0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0}, p},                    // e0 zero
      {{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, p},                    // a point
      {{0, 0, 1, nan, 0, 0, 0, 0, 0, 0, 1, 0}, p},
      {{0, 0, 1, 1, 0, 0, 0, infinity, 0, 0, 1, 0}, p},
  };
  for (const Configuration<double>& c : outside) {
    Truth<T> truth = TruthOf<T>(c);
    EXPECT_FALSE(truth.InDomain());
    EXPECT_FALSE(truth.Active());
    EXPECT_NE(truth.Value(), truth.Value());
    EXPECT_TRUE(AllNaN(truth.Gradient()) && AllNaN(FrameMap(truth)));
    EXPECT_TRUE(AllNaN(truth.HessianSpectrum().values));
    for (const Filter<T>& filter : AllFilters<T>())
      EXPECT_TRUE(AllNaN(filter.define(truth))) << filter.name;
  }
  // Sine 1.02e-8.
  const Configuration<double> inside{{0, 0, 1, 1, 0, 0, 0, 0, 0, std::sqrt(0.5), 0.72e-8, 0}, p};
  EXPECT_TRUE(TruthOf<T>(inside).InDomain());
}

TYPED_TEST(TruthTest, IsNaNOutsideTheDomainOfEdges) {
  using T = TypeParam;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const std::string_view name : kEdgeEdge) {
    for (const double bad : {nan, infinity, -infinity}) {
      for (size_t i = 0; i < 12; ++i) {
        Configuration<double> c = UnitEdges({0.5, 0.25, 0.5}, kY, 1);
        c.x.data()[i] = bad;
        EXPECT_FALSE(TruthOf<T>(name, c).InDomain()) << name << ", entry " << i << ", " << bad;
      }
    }
    const std::array<double, 5> p{1, 2, 1};
    for (const Configuration<double>& c :
         {Configuration<double>{{0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 0}, p},
          Configuration<double>{{0, 1, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0}, p},
          Configuration<double>{{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, p}}) {
      EXPECT_FALSE(TruthOf<T>(name, c).InDomain()) << name << ", a point";
    }
  }
  const Configuration<double> touching{{0.5, 0.5, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0}, {1, 2, 1}};
  Truth<T> truth = TruthOf<T>(kUnsignedVertexFace, touching);
  EXPECT_FALSE(truth.InDomain());
  for (const Filter<T>& filter : AllFilters<T>())
    EXPECT_TRUE(AllNaN(filter.define(truth))) << filter.name;
}

TYPED_TEST(TruthTest, KeepsANaNOfTheVertex) {
  using T = TypeParam;
  const Configuration<double> c{{0, 0, std::nan(""), 1, 0, 0, 0, 0, 0, 0, 1, 0}, {1, 0.5, 1}};
  Truth<T> truth = TruthOf<T>(c);
  EXPECT_NE(truth.Value(), truth.Value());
  EXPECT_NE(FrobeniusNorm(truth.Hessian()), FrobeniusNorm(truth.Hessian()));
  EXPECT_TRUE(AllNaN(truth.Nearest()));
}

TYPED_TEST(TruthTest, RefusesWhatTheEnergyLacks) {
  using T = TypeParam;
  Energy<T> bare = *FindEnergy<T>(kName);
  bare.frame = nullptr;
  bare.curvature = nullptr;
  const double x[] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, p[] = {1, 1, 1};
  Truth<T> truth(bare, x, p);
  EXPECT_THROW(truth.FrameTerms(), std::logic_error);
  EXPECT_THROW(truth.Curvature(), std::logic_error);
  EXPECT_GT(FrobeniusNorm(truth.Nearest()), 0);
}

TEST(Truth, AgreesBetweenDoubleAndQuad) {
  const auto to_double = [](const Matrix<Quad>& a) {
    Matrix<double> b(a.rows, a.cols);
    for (int i = 0; i < a.rows * a.cols; ++i) b[i] = static_cast<double>(a[i]);
    return b;
  };
  ForEveryCollision([&](std::string_view name, const Configuration<Quad>& c) {
    Configuration<double> rounded;
    for (size_t i = 0; i < 12; ++i) rounded.x.data()[i] = static_cast<double>(c.x.data()[i]);
    for (size_t i = 0; i < 5; ++i) rounded.p.data()[i] = static_cast<double>(c.p.data()[i]);
    Truth<double> rough = TruthOf<double>(name, rounded);
    Truth<Quad> exact = TruthOf<Quad>(name, rounded);
    EXPECT_TRUE(rough.Active() && exact.Active());
    EXPECT_NEAR(rough.Value(), static_cast<double>(exact.Value()), 1e-12 * rough.Value());
    EXPECT_LT(Difference(rough.Gradient(), to_double(exact.Gradient())), 1e-10);
    EXPECT_LT(Difference(FrameMap(rough), to_double(FrameMap(exact))), 1e-10);
    for (const Filter<Quad>& filter : AllFilters<Quad>()) {
      if (Lacks(name, filter.name)) continue;
      EXPECT_LT(Difference(FindFilter<double>(filter.name)->define(rough),
                           to_double(filter.define(exact))),
                1e-10)
          << filter.name;
    }
  });
}

TEST(Filters, OfTheFrameHaveTheDefinitionsOfTheirNamesakes) {
  ForEveryCollision([](std::string_view energy, const Configuration<Quad>& c) {
    const auto define = [&](std::string_view name) {
      Truth<Quad> truth = TruthOf<Quad>(energy, c);
      return FindFilter<Quad>(name)->define(truth).entries;
    };
    if (!Lacks(energy, "gauss_newton")) {
      EXPECT_EQ(define("gauss_newton_frame"), define("gauss_newton"));
    }
    EXPECT_EQ(define("nearest"), define("numeric"));
    for (const std::string_view name : {"analytic_printed", "analytic_frame", "numeric_frame"})
      EXPECT_EQ(define(name), define("analytic")) << name;
  });
}

// |a| = 2 max(a, 0) - a, term by term.
TEST(Filters, AbsoluteOnesAddWhatClampingAddsTwice) {
  ForEveryCollision([](std::string_view energy, const Configuration<Quad>& c) {
    Truth<Quad> truth = TruthOf<Quad>(energy, c);
    for (const auto& [name, clamping] :
         {std::pair("absolute", "analytic"), std::pair("absolute_numeric", "numeric")}) {
      const Matrix<Quad> clamped = FindFilter<Quad>(clamping)->define(truth);
      const Matrix<Quad> absolute = FindFilter<Quad>(name)->define(truth);
      EXPECT_LT(Difference(absolute, clamped + (clamped - truth.Hessian())), 1e-28) << name;
    }
    const auto define = [&](std::string_view name) {
      return FindFilter<Quad>(name)->define(truth);
    };
    const Matrix<Quad> blend = define("blend_half");
    EXPECT_LT(Difference(blend + blend, define("analytic") + define("absolute")), 1e-30);
  });
}

TEST(Filters, AreWhatTheirNamesSay) {
  ForRandomConfigurations(5, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const auto define = [&](std::string_view name) {
      return FindFilter<Quad>(name)->define(truth);
    };
    EXPECT_EQ(define("none").entries, truth.Hessian().entries);
    EXPECT_EQ(define("gauss_newton").entries, truth.Curvature().entries);
    EXPECT_EQ(define("numeric").entries, truth.Nearest().entries);
    EXPECT_EQ(define("analytic").entries, define("analytic_printed").entries);
    for (const char* name :
         {"numeric_negatives", "numeric_reduced", "numeric_lapack_d", "numeric_lapack_r",
          "numeric_float", "numeric_probed", "ql_12", "ql_5", "jacobi_12", "jacobi_5"})
      EXPECT_EQ(define(name).entries, truth.Nearest().entries) << name;
    for (const char* name : {"ql_9", "jacobi_9"})
      EXPECT_EQ(define(name).entries, define("analytic").entries) << name;

    // The analytic filter is PSD and only adds to the Hessian, by S^T (F+ - F) S; it keeps three
    // modes, as the frame Hessian has two negative eigenvalues among nine, four of them zero.
    const Matrix<Quad> analytic = define("analytic");
    const Quad tolerance = Quad(1e-30) * FrobeniusNorm(analytic);
    const Matrix<Quad> kept = SpectrumOf(analytic).values;
    EXPECT_GT(kept[0], -tolerance);
    EXPECT_LT(kept[8], tolerance);
    EXPECT_GT(kept[9], tolerance);
    const Matrix<Quad> added = SpectrumOf(analytic - truth.Hessian()).values;
    EXPECT_GT(added[0], -tolerance);
    EXPECT_LT(added[9], tolerance);
    EXPECT_GT(added[10], tolerance);
    EXPECT_GT(Difference(analytic, truth.Nearest()), 1e-6) << "not the nearest in x";
  });
}

TEST(Filters, ThatShiftAddTheLeastThatTheirBoundAsksFor) {
  ForRandomConfigurations(5, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Matrix<Quad>& h = truth.Hessian();
    const Quad tolerance = Quad(1e-30) * FrobeniusNorm(h);
    const Matrix<Quad> diagonal = FindFilter<Quad>("shift_diagonal")->define(truth);
    EXPECT_LT(abs(SpectrumOf(diagonal).values[0]), tolerance);
    const Matrix<Quad> dominant = FindFilter<Quad>("shift_gershgorin")->define(truth);
    Quad least = FrobeniusNorm(dominant);
    for (int i = 0; i < h.rows; ++i) {
      Quad excess = 2 * dominant(i, i);
      for (int j = 0; j < h.cols; ++j) excess -= abs(dominant(i, j));
      least = std::min(least, excess);
    }
    EXPECT_LT(abs(least), tolerance);
    for (const Matrix<Quad>& shifted : {diagonal, dominant}) {
      const Matrix<Quad> added = shifted - h;
      for (int i = 0; i < h.rows; ++i)
        for (int j = 0; j < h.cols; ++j)
          EXPECT_LT(abs(added(i, j) - (i == j ? added(0, 0) : Quad(0))), tolerance);
    }
  });
}

TEST(Filters, OfVertexBlocksClampEachVertexAlone) {
  ForRandomConfigurations(5, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Matrix<Quad> blocks = FindFilter<Quad>("vertex_blocks")->define(truth);
    Matrix<Quad> own = truth.Hessian();
    for (int i = 0; i < own.rows; ++i)
      for (int j = 0; j < own.cols; ++j)
        if (i / 3 != j / 3) own(i, j) = 0;
    // The spectrum of a block diagonal matrix is that of its blocks.
    EXPECT_LT(Difference(blocks, NearestPsd(SpectrumOf(own))), 1e-28);
  });
}

TYPED_TEST(TruthTest, TablesHoldEveryRowOnce) {
  using T = TypeParam;
  const auto names = [](const auto& rows) {
    std::multiset<std::string_view> all;
    for (const auto& row : rows) all.insert(row.name);
    return all;
  };
  const auto energies = names(AllEnergies<T>());
  const auto filters = names(AllFilters<T>());
  for (const std::string name :
       {"vertex_face/signed", "vertex_face/unsigned", "vertex_face/anisotropic", "edge_edge/signed",
        "edge_edge/unsigned", "edge_edge/unsigned_frozen", "edge_edge/hybrid",
        "edge_edge/anisotropic", "edge_edge/mollified", "vertex_edge/unsigned",
        "vertex_vertex/unsigned"}) {
    for (const std::string penalty : {"quadratic", "cubic", "log_barrier"}) {
      const bool makes_sense = !name.ends_with("anisotropic") || penalty != "log_barrier";
      EXPECT_EQ(energies.count("collision/" + name + "/" + penalty), makes_sense) << name;
    }
  }
  for (const char* name : {"none", "gauss_newton", "gauss_newton_frame", "analytic",
                           "analytic_printed", "analytic_frame", "numeric", "numeric_frame",
                           "absolute", "absolute_numeric", "split", "nearest", "blend_half"})
    EXPECT_EQ(filters.count(name), 1u) << name;
  EXPECT_EQ(std::set(energies.begin(), energies.end()).size(), energies.size());
  EXPECT_EQ(std::set(filters.begin(), filters.end()).size(), filters.size());
  for (const Energy<T>& energy : AllEnergies<T>()) EXPECT_EQ(FindEnergy<T>(energy.name), &energy);
  EXPECT_EQ(FindEnergy<T>("collision/none"), nullptr);
  EXPECT_EQ(FindFilter<T>("nearly"), nullptr);
}

}  // namespace
}  // namespace definite::reference
