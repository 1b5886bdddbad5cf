#pragma once

// Stable Neo-Hookean, J = det F: psi = mu/2 (|F|^2 - d) - mu (J - 1) + lambda/2 (J - 1)^2.
//
// Source: Smith, de Goes and Kim 2019, appendix F.4 (and 2018, Eq. 13), with (J - 1 - mu/lambda)^2
// written out and the constant dropped: rest has no energy.
// Parameters: mu, lambda (energies).

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct StableNeoHookean {
  static constexpr std::string_view kName = "stable_neo_hookean";
  static constexpr std::string_view kSource = "Smith et al. 2018, Eq. 13; 2019, appendix F";
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness of shape, times the rest volume"},
      {"lambda", 10.0, 2, "stiffness of volume, times the rest volume"},
  };
  static constexpr Stretchable kDomain = Stretchable::kAlways;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> x = Each(s, [](const T& si) { return si - T(1.0); });
    // J - 1 = sum x + products, |F|^2 - d = 2 sum x + sum x^2
    const T products = ProductsOf(x), change = Sum(x) + products;
    return MulAdd(p[0], T(0.5) * Dot(x, x) - products, T(0.5) * p[1] * change * change);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const T pressure = Pressure(s, p);
    Vec<T, D> slopes;
    for (int i = 0; i < D; ++i) slopes[i] = MulAdd(p[0], s[i], pressure * OthersOf(s, i));
    return slopes;
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return MulAdd(Pressure(s, p), pair.third, p[0]);
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return MulAdd(-Pressure(s, p), pair.third, p[0]);
  }
  template <class T, int D>
  static PackedSym<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    const T pressure = Pressure(s, p);
    return SymmetricOf<D>([&](int i, int j) {
      const T both = p[1] * OthersOf(s, i) * OthersOf(s, j);
      return i == j ? both + p[0] : MulAdd(pressure, ThirdOf(s, i, j), both);
    });
  }

  // The derivative of psi in J.
  template <class T, int D>
  static T Pressure(const Vec<T, D>& s, const T* p) {
    return MulAdd(p[1], Product(s) - T(1.0), -p[0]);
  }
  // The stretch that is neither; 1 in two dimensions.
  template <class T, int D>
  static T ThirdOf(const Vec<T, D>& s, int i, int j) {
    if constexpr (D == 2) return T(1.0);
    return s[3 - i - j];
  }
};

DEFINITE_ENERGY(Distortion<Triangle, StableNeoHookean>);
DEFINITE_ENERGY(Distortion<Tetrahedron, StableNeoHookean>);

}  // namespace definite
