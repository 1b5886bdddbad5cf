#pragma once

// An isotropic distortion energy as a function psi(s) of principal stretches, of which
// distortion.hpp makes an energy of vertices. s1 >= s2 >= |s3|, and the last has the sign of det F.
//
// Source: Smith, de Goes and Kim 2019, sections 4 and 5, in terms of stretches instead of
// invariants: over the singular vectors u_i, v_i of F the Hessian of psi has, for each pair (j, k),
//   twist (psi_j + psi_k)/(s_j + s_k) on (u_k v_j^T - u_j v_k^T)/sqrt 2,
//   flip  (psi_j - psi_k)/(s_j - s_k) on (u_k v_j^T + u_j v_k^T)/sqrt 2,
// and on the u_i v_i^T the scaling block A_ij = psi_ij.

#include <concepts>
#include <span>
#include <string_view>

#include "kernels/core/precision.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// Where psi is defined, in terms that any decomposition can tell.
enum class Stretchable {
  kAlways,
  kWithRotation,  // (s1 + s2)(s2 + s3)(s3 + s1) > kTau (s1 + s2 + s3)^3; 2D: s1 + s2 > kTau |F|
  kNotInverted,   // det F > 0, and |F| |F^-1| < 1/kTau
};

// Two stretches s_j, s_k, and the one that is neither; 1 in two dimensions.
template <class T>
struct StretchPair {
  T j, k, third;
};

template <int D>
inline constexpr int kStretchPairs = D*(D - 1) / 2;

// Pair i in three dimensions is the one without stretch i.
template <int D>
constexpr int FirstOf(int pair) {
  return D == 3 && pair == 0 ? 1 : 0;
}
template <int D>
constexpr int SecondOf(int pair) {
  return D == 3 && pair < 2 ? 2 : 1;
}
template <int D, class T>
DEFINITE_INLINE StretchPair<T> PairOf(const Vec<T, D>& s, int pair) {
  const T third = D == 3 ? s[D == 3 ? pair : 0] : T(1.0);
  return {s[FirstOf<D>(pair)], s[SecondOf<D>(pair)], third};
}

template <class T, int D>
DEFINITE_INLINE T Sum(const Vec<T, D>& s) {
  T sum = s[0];
  for (int i = 1; i < D; ++i) sum = sum + s[i];
  return sum;
}
template <class T, int D>
DEFINITE_INLINE T Product(const Vec<T, D>& s) {
  T product = s[0];
  for (int i = 1; i < D; ++i) product = product * s[i];
  return product;
}
// f of each.
template <class T, int D, class Map>
DEFINITE_INLINE Vec<T, D> Each(const Vec<T, D>& s, Map f) {
  Vec<T, D> r;
  for (int i = 0; i < D; ++i) r[i] = f(s[i]);
  return r;
}
// The product of the other stretches.
template <class T, int D>
DEFINITE_INLINE T OthersOf(const Vec<T, D>& s, int i) {
  if constexpr (D == 2) return s[1 - i];
  return s[i == 0 ? 1 : 0] * s[i == 2 ? 1 : 2];
}
// det F - 1 less sum x, at stretches 1 + x.
template <class T, int D>
DEFINITE_INLINE T ProductsOf(const Vec<T, D>& x) {
  if constexpr (D == 2) return x[0] * x[1];
  return x[0] * x[1] + x[2] * (x[0] + x[1] + x[0] * x[1]);
}
// The symmetric matrix of entry(i, j), i <= j.
template <int D, class Entry>
DEFINITE_INLINE auto SymmetricOf(Entry entry) {
  PackedSym<decltype(entry(0, 0)), D> a;
  int k = 0;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) a.a[k++] = entry(i, j);
  }
  return a;
}

// What psi must define, for stretches in two dimensions or three; p are its own parameters. Scaling
// is a Vec, where A is diagonal; a PackedSym; or the Modes of A, where they are known. Optional:
// PairCurvature(s, pair, p), the modes over (u_j v_k^T, u_k v_j^T) that Gauss-Newton keeps, beside
// ScalingCurvature(s, p), which is what Scaling may be.
template <class Psi, class T, int D>
concept StretchEnergy = requires(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
  { Psi::kName } -> std::convertible_to<std::string_view>;
  { Psi::kSource } -> std::convertible_to<std::string_view>;
  {std::span<const Parameter>(Psi::kParameters)};
  { Psi::kDomain } -> std::convertible_to<Stretchable>;
  { Psi::Value(s, p) } -> std::same_as<T>;
  { Psi::Slopes(s, p) } -> std::same_as<Vec<T, D>>;
  { Psi::Twist(s, pair, p) } -> std::same_as<T>;
  { Psi::Flip(s, pair, p) } -> std::same_as<T>;
  Psi::Scaling(s, p);
};

// Twist and flip of a psi that knows its first and second derivatives alone. Where two stretches
// are close, the quotient of the flip loses u over their difference: it is the mean of a second
// derivative along the way from (s_j, s_k) to (s_k, s_j), and three Gauss points are exact to
// rounding there.
template <class Psi>
struct ByQuotients {
  static constexpr double kClose = 1e-3;

  template <class T, int D>
  static DEFINITE_INLINE T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    const Vec<T, D> at = At(s, pair, T(0.0)), slope = Psi::Slopes(at, p);
    return (slope[0] + slope[1]) / (pair.j + pair.k);
  }
  template <class T, int D>
  static DEFINITE_INLINE T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    const Vec<T, D> at = At(s, pair, T(0.0)), slope = Psi::Slopes(at, p);
    const T difference = pair.j - pair.k;
    const auto close = Abs(difference) < T(kClose) * (Abs(pair.j) + Abs(pair.k));
    const T mean = T(4.0 / 9.0) * Second(At(s, pair, T(0.5)), p) +
                   T(5.0 / 9.0) * Second(At(s, pair, T(0.11270166537925831)), p);
    return Select(close, mean, (slope[0] - slope[1]) / Select(close, T(1.0), difference));
  }

 private:
  // The pair first, part of the way to its exchange; psi is symmetric in its stretches.
  template <class T, int D>
  static DEFINITE_INLINE Vec<T, D> At(const Vec<T, D>&, const StretchPair<T>& pair, const T& way) {
    Vec<T, D> at;
    const T step = way * (pair.k - pair.j);
    at[0] = pair.j + step;
    at[1] = pair.k - step;
    if constexpr (D == 3) at[2] = pair.third;
    return at;
  }
  template <class T, int D>
  static DEFINITE_INLINE T Second(const Vec<T, D>& at, const T* p) {
    const PackedSym<T, D> a = Psi::Scaling(at, p);
    return T(0.5) * (a.a[0] + a.a[D]) - a.a[1];
  }
};

}  // namespace definite
