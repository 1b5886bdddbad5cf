// Isotropic distortion energies where forms of stretches matter: next to rest, and where two
// stretches are equal or opposite. That they are right elsewhere, verify and the contracts say.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kernels/energies/distortion_arap.hpp"
#include "kernels/energies/distortion_corotational.hpp"
#include "kernels/energies/distortion_mips.hpp"
#include "kernels/energies/distortion_neo_hookean.hpp"
#include "kernels/energies/distortion_st_venant_kirchhoff.hpp"
#include "kernels/energies/distortion_stable_neo_hookean.hpp"
#include "kernels/energies/distortion_stable_neo_hookean_log.hpp"
#include "kernels/energies/distortion_symmetric_arap.hpp"
#include "kernels/energies/distortion_symmetric_dirichlet.hpp"
#include "reference/energies/distortion_arap.hpp"
#include "reference/energies/distortion_corotational.hpp"
#include "reference/energies/distortion_mips.hpp"
#include "reference/energies/distortion_neo_hookean.hpp"
#include "reference/energies/distortion_st_venant_kirchhoff.hpp"
#include "reference/energies/distortion_stable_neo_hookean.hpp"
#include "reference/energies/distortion_stable_neo_hookean_log.hpp"
#include "reference/energies/distortion_symmetric_arap.hpp"
#include "reference/energies/distortion_symmetric_dirichlet.hpp"
#include "reference/quad.hpp"

namespace definite {

using reference::Quad;

// Boost 1.74 declares a log1p of its float128 that does not compile. x is a double here.
template <>
inline Quad Log1p(const Quad& x) {
  return log(1 + x);
}

namespace {

template <int D>
Vec<Quad, D> InQuad(const Vec<double, D>& s) {
  Vec<Quad, D> q;
  for (int i = 0; i < D; ++i) q[i] = s[i];
  return q;
}

double RelativeError(double ours, const Quad& truth) {
  const Quad error = abs(Quad(ours) - truth);
  return static_cast<double>(truth == 0 ? error : Quad(error / abs(truth)));
}

// Parameters with which no term vanishes.
constexpr double kOwn[] = {1.25, 3.5};
const Quad kOwnInQuad[] = {1.25, 3.5};

// The quotients of derivatives that twist and flip are, in float128; their limit where 0/0.
template <class Psi, int D>
Quad TwistOf(const Vec<double, D>& s, int pair) {
  const Vec<Quad, D> q = InQuad(s), slopes = Psi::Slopes(q, kOwnInQuad);
  const int j = FirstOf<D>(pair), k = SecondOf<D>(pair);
  return (slopes[j] + slopes[k]) / (q[j] + q[k]);
}
template <class Psi, int D>
Quad FlipOf(const Vec<double, D>& s, int pair) {
  Vec<Quad, D> q = InQuad(s);
  const int j = FirstOf<D>(pair), k = SecondOf<D>(pair);
  if (q[j] == q[k]) q[j] *= 1 + Quad(1e-17);  // of 34 digits 17 are left
  const Vec<Quad, D> slopes = Psi::Slopes(q, kOwnInQuad);
  return (slopes[j] - slopes[k]) / (q[j] - q[k]);
}

template <class Psi, int D>
double TwistError(const Vec<double, D>& s, int pair = 0) {
  return RelativeError(Psi::Twist(s, PairOf<D>(s, pair), kOwn), TwistOf<Psi>(s, pair));
}
template <class Psi, int D>
double FlipError(const Vec<double, D>& s, int pair = 0) {
  return RelativeError(Psi::Flip(s, PairOf<D>(s, pair), kOwn), FlipOf<Psi>(s, pair));
}

TEST(Distortion, FlipsKeepTheirDigitsWhereStretchesAreEqual) {
  for (const double delta : {1e-4, 1e-8, 1e-12, 0.0}) {
    const Vec<double, 3> s = {1.7, 0.8 + delta, 0.8};
    EXPECT_LT((FlipError<Arap>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<Corotational>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<SymmetricDirichlet>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<SymmetricArap>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<StVenantKirchhoff>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<StableNeoHookean>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<StableNeoHookeanLog>(s)), 1e-15) << delta;
    EXPECT_LT((FlipError<NeoHookean>(s)), 1e-15) << delta;
  }
}

TEST(Distortion, TwistsKeepTheirDigitsWhereStretchesAreOpposite) {
  for (const double delta : {1e-4, 1e-8, 1e-12}) {
    const Vec<double, 3> s = {1.7, 0.8 + delta, -0.8};
    EXPECT_LT((TwistError<Arap>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<Corotational>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<StVenantKirchhoff>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<StableNeoHookean>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<StableNeoHookeanLog>(s)), 1e-15) << delta;
  }
}

TEST(Distortion, TwistsKeepTheirDigitsWhereTwoStretchesAreSmall) {
  for (const double delta : {1e-4, 1e-8, 1e-12}) {
    const Vec<double, 3> s = {1, 1.3 * delta, delta};
    EXPECT_LT((TwistError<SymmetricDirichlet>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<SymmetricArap>(s)), 1e-15) << delta;
    EXPECT_LT((TwistError<NeoHookean>(s)), 1e-15) << delta;
  }
}

TEST(Distortion, MipsTwistKeepsItsDigitsNextToRest) {
  for (const double delta : {1e-1, 1e-4, 1e-8}) {
    const Vec<double, 2> s = {1 + delta, 1};
    EXPECT_LT((TwistError<Mips>(s)), 1e-15) << delta;
  }
}

// The product that it is made of has no difference to lose; the printed sum does.
TEST(Distortion, MipsNegativePairOfTheScalingBlockKeepsItsDigits) {
  for (const double delta : {1e-1, 1e-4, 1e-8}) {
    const Vec<double, 2> s = {1 + delta, 1};
    const Vec<Quad, 2> q = InQuad(s);
    const Quad area = q[0] * q[1], squares = q[0] * q[0] + q[1] * q[1];
    const Quad alpha = sqrt(squares * squares - 3 * area * area);
    const Quad printed =
        kOwnInQuad[0] * (squares * (squares - alpha) - 2 * area * area) / (area * area * area);
    EXPECT_LT(RelativeError(Mips::Scaling(s, kOwn).lambda[1], printed), 1e-15) << delta;
  }
}

// Values at stretches 1 + e (1, -0.3, 0.5), against the plain form over F in float128.
template <class Psi, class Plain, int D>
double ValueError(double e) {
  const double direction[] = {1, -0.3, 0.5};
  Vec<double, D> s;
  reference::Gradient<Quad, D> f{};
  for (int i = 0; i < D; ++i) {
    s[i] = 1 + e * direction[i];
    f(i, i) = s[i];
  }
  return RelativeError(Psi::Value(s, kOwn), Plain::Value(f, kOwnInQuad));
}

TEST(Distortion, ValuesKeepTheirDigitsNextToRest) {
  for (const double e : {1.0, 1e-1, 1e-2, 1e-4, 1e-6, 1e-8}) {
    EXPECT_LT((ValueError<Arap, reference::Arap, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<Corotational, reference::Corotational, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<SymmetricDirichlet, reference::SymmetricDirichlet, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<SymmetricArap, reference::SymmetricArap, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<StVenantKirchhoff, reference::StVenantKirchhoff, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<StableNeoHookean, reference::StableNeoHookean, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<StableNeoHookeanLog, reference::StableNeoHookeanLog, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<NeoHookean, reference::NeoHookean, 3>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<Mips, reference::Mips, 2>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<StableNeoHookean, reference::StableNeoHookean, 2>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<StableNeoHookeanLog, reference::StableNeoHookeanLog, 2>(e)), 2e-15) << e;
    EXPECT_LT((ValueError<NeoHookean, reference::NeoHookean, 2>(e)), 2e-15) << e;
  }
}

// Somebody's own psi, by its derivatives alone: Hencky's, of logarithms of stretches.
struct Hencky : ByQuotients<Hencky> {
  static constexpr std::string_view kName = "hencky";
  static constexpr std::string_view kSource = "Hencky 1928";
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, ""}, {"lambda", 1.0, 2, ""}};
  static constexpr Stretchable kDomain = Stretchable::kNotInverted;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> logs = Each(s, [](const T& si) { return Log(si); });
    return p[0] * Dot(logs, logs) + T(0.5) * p[1] * Sum(logs) * Sum(logs);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const T volume = p[1] * Log(definite::Product(s));
    return Each(s, [&](const T& si) { return (T(2.0) * p[0] * Log(si) + volume) / si; });
  }
  template <class T, int D>
  static PackedSym<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    const T volume = p[1] * Log(definite::Product(s));
    return SymmetricOf<D>([&](int i, int j) {
      const T cross = p[1] / (s[i] * s[j]);
      return i == j ? cross + (T(2.0) * p[0] * (T(1.0) - Log(s[i])) - volume) / (s[i] * s[i])
                    : cross;
    });
  }
};

TEST(OwnPsi, HasTwistsAndFlipsByQuotients) {
  double worst = 0;
  for (double delta = 1; delta > 1e-16; delta /= 3) {
    const Vec<double, 3> s = {1.7, 0.8 + delta, 0.8};
    worst = std::max({worst, FlipError<Hencky>(s), TwistError<Hencky>(s)});
  }
  EXPECT_LT(worst, 1e-12);
  const Vec<double, 3> equal = {1.7, 0.8, 0.8};
  EXPECT_LT((FlipError<Hencky>(equal)), 1e-14);
}

TEST(OwnPsi, IsAnEnergyOfItsVertices) {
  using Energy = Distortion<Tetrahedron, Hencky>;
  static_assert(EnergyOver<Energy, double> && WithFrame<Energy, double>);
  const double shape[] = {0, 0, 0, 1.2, 0.1, -0.2, 0.3, 0.9, 0.1, -0.1, 0.2, 1.4};
  Vec<Quad, 12> x;
  for (int i = 0; i < 12; ++i) x[i] = shape[i];
  Vec<Quad, Energy::kParams> p;
  for (int i = 0; i < Energy::kParams; ++i)
    p[i] = Energy::kParameters[static_cast<std::size_t>(i)].value;
  const auto h = ToPacked(Energy::HessianModes<Set::kExact, Part::kAll>(x, p));
  const Quad step = 1e-12;
  int k = 0;
  for (int i = 0; i < 12; ++i) {
    Vec<Quad, 12> before = x, after = x;
    before[i] -= step;
    after[i] += step;
    const Quad slope = (Energy::Value(after, p) - Energy::Value(before, p)) / (2 * step);
    EXPECT_LT(abs(slope - Energy::Gradient(x, p)[i]), 1e-20);
    const auto difference = Energy::Gradient(after, p) - Energy::Gradient(before, p);
    for (int j = i; j < 12; ++j, ++k) EXPECT_LT(abs(difference[j] / (2 * step) - h.a[k]), 1e-20);
  }
}

TEST(Distortion, TurnedInsideOutHasItsClosestRotation) {
  // Stretches (2, 1, -0.5): the reflection is on the smallest, so R turns no direction around.
  const double shape[] = {0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, -0.5};
  using Energy = Distortion<Tetrahedron, Arap>;
  Vec<double, 12> x;
  for (int i = 0; i < 12; ++i) x[i] = shape[i];
  Vec<double, Energy::kParams> p;
  for (int i = 0; i < Energy::kParams; ++i)
    p[i] = Energy::kParameters[static_cast<std::size_t>(i)].value;
  EXPECT_DOUBLE_EQ(Energy::Value(x, p), 1 + 0 + 1.5 * 1.5);
}

}  // namespace
}  // namespace definite
