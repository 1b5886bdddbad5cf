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

#include "reference/oracle.hpp"
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
  std::array<T, 3> p;
};

Configuration<double> DrawActive(std::mt19937_64& random) {
  while (true) {
    Configuration<double> c;
    for (double& entry : c.x) entry = Draw(random, 0, 1);
    c.p = {Draw(random, 0.5, 2), Draw(random, 0.1, 1), Draw(random, -1, 1)};
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
using Solvers = testing::Types<JacobiQuad, JacobiDouble, EigenDouble>;
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

TEST(SignedVertexFace, DerivativesMatchDifferences) {
  const Energy<Quad>& energy = *FindEnergy<Quad>(kName);
  ForRandomConfigurations(20, [&](const Configuration<double>& c) {
    std::array<Quad, 12> x;
    std::copy(c.x.begin(), c.x.end(), x.begin());
    const std::vector<Quad> p(c.p.begin(), c.p.end());
    ExpectDerivativesMatchDifferences<12>(
        [&](const Quad* at) { return energy.value(at, p.data()); },
        [&](const Quad* at) { return energy.derivatives(at, p.data()); }, x, 1e-18);
  });
}

TEST(SignedVertexFace, HasThreePositiveAndTwoNegativeEigenvalues) {
  ForRandomConfigurations(50, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    const Quad tolerance = Quad(1e-25) * FrobeniusNorm(truth.Hessian());
    int positive = 0, negative = 0;
    for (const Quad& lambda : truth.HessianSpectrum().values.entries) {
      positive += lambda > tolerance;
      negative += lambda < -tolerance;
    }
    EXPECT_EQ(positive, 3);
    EXPECT_EQ(negative, 2);
  });
}

TEST(SignedVertexFace, IgnoresTranslations) {
  Matrix<Quad> translations(12, 3);
  for (int i = 0; i < 12; ++i) translations(i, i % 3) = Quad(1);
  ForRandomConfigurations(20, [&](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    EXPECT_LT(FrobeniusNorm(truth.Hessian() * translations),
              Quad(1e-31) * FrobeniusNorm(truth.Hessian()));
    EXPECT_LT(FrobeniusNorm(truth.FrameMap() * translations), Quad(1e-31));
  });
}

// Shi & Kim 2023, section 4.3: for signed length the frozen weights lose nothing.
TEST(SignedVertexFace, FrameHessianPullsBackToTheHessian) {
  ForRandomConfigurations(20, [](const Configuration<double>& c) {
    Truth<Quad> truth = TruthOf<Quad>(c);
    EXPECT_LT(Difference(Congruence(truth.FrameHessian(), truth.FrameMap()), truth.Hessian()),
              1e-28);
  });
}

// That identity holds for any weights; these are the Gram-Schmidt ones.
TEST(SignedVertexFace, FrameIsOrthogonalAndSpansTheEdges) {
  ForRandomConfigurations(20, [](const Configuration<double>& c) {
    Matrix<Quad> x(12, 1);
    std::copy(c.x.begin(), c.x.end(), x.entries.begin());
    const Matrix<Quad> frame = TruthOf<Quad>(c).FrameMap() * x;
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
      EXPECT_LT(Difference(Congruence(far.FrameHessian(), far.FrameMap()), far.Hessian()), 1e-28);
    }
  });
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
    EXPECT_TRUE(AllEqual(truth.FrameHessian(), T(0)));
    EXPECT_TRUE(AllEqual(truth.HessianSpectrum().values, T(0)));
    for (const Filter<T>& filter : AllFilters<T>())
      EXPECT_TRUE(AllEqual(filter.define(truth), T(0))) << filter.name;
  });
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
  const std::array<double, 3> p{1, 2, 1};
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
    EXPECT_TRUE(AllNaN(truth.Gradient()) && AllNaN(truth.FrameMap()));
    EXPECT_TRUE(AllNaN(truth.HessianSpectrum().values));
    for (const Filter<T>& filter : AllFilters<T>())
      EXPECT_TRUE(AllNaN(filter.define(truth))) << filter.name;
  }
  // Sine 1.02e-8.
  const Configuration<double> inside{{0, 0, 1, 1, 0, 0, 0, 0, 0, std::sqrt(0.5), 0.72e-8, 0}, p};
  EXPECT_TRUE(TruthOf<T>(inside).InDomain());
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
  EXPECT_THROW(truth.FrameHessian(), std::logic_error);
  EXPECT_THROW(truth.Curvature(), std::logic_error);
  EXPECT_GT(FrobeniusNorm(truth.Nearest()), 0);
}

TEST(Truth, AgreesBetweenDoubleAndQuad) {
  const auto to_double = [](const Matrix<Quad>& a) {
    Matrix<double> b(a.rows, a.cols);
    for (int i = 0; i < a.rows * a.cols; ++i) b[i] = static_cast<double>(a[i]);
    return b;
  };
  ForRandomConfigurations(20, [&](const Configuration<double>& c) {
    Truth<double> rough = TruthOf<double>(c);
    Truth<Quad> exact = TruthOf<Quad>(c);
    EXPECT_NEAR(rough.Value(), static_cast<double>(exact.Value()), 1e-12 * rough.Value());
    EXPECT_LT(Difference(rough.Gradient(), to_double(exact.Gradient())), 1e-10);
    EXPECT_LT(Difference(rough.FrameMap(), to_double(exact.FrameMap())), 1e-10);
    for (const Filter<Quad>& filter : AllFilters<Quad>())
      EXPECT_LT(Difference(FindFilter<double>(filter.name)->define(rough),
                           to_double(filter.define(exact))),
                1e-10)
          << filter.name;
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

TYPED_TEST(TruthTest, TablesHoldEveryRowOnce) {
  using T = TypeParam;
  const auto names = [](const auto& rows) {
    std::multiset<std::string_view> all;
    for (const auto& row : rows) all.insert(row.name);
    return all;
  };
  const auto energies = names(AllEnergies<T>());
  const auto filters = names(AllFilters<T>());
  EXPECT_EQ(energies.count(kName), 1u);
  for (const char* name : {"none", "gauss_newton", "analytic", "analytic_printed", "numeric"})
    EXPECT_EQ(filters.count(name), 1u) << name;
  EXPECT_EQ(std::set(energies.begin(), energies.end()).size(), energies.size());
  EXPECT_EQ(std::set(filters.begin(), filters.end()).size(), filters.size());
  for (const Energy<T>& energy : AllEnergies<T>()) EXPECT_EQ(FindEnergy<T>(energy.name), &energy);
  EXPECT_EQ(FindEnergy<T>("collision/none"), nullptr);
  EXPECT_EQ(FindFilter<T>("nearly"), nullptr);
}

}  // namespace
}  // namespace definite::reference
