#pragma once

// Stable Neo-Hookean with the term that keeps collapsed elements stiff, J = det F, g = d/(d + 1):
// psi = mu/2 (|F|^2 - d) - mu g (J - 1) + lambda/2 (J - 1)^2 - mu/2 log((|F|^2 + 1)/(d + 1)).
//
// Source: Smith, de Goes and Kim 2018, Eq. 14, with (J - alpha)^2 written out and constants
// dropped: rest has no energy. Parameters: mu, lambda (energies).

#include "kernels/distortion/logarithms.hpp"
#include "kernels/energies/distortion_stable_neo_hookean.hpp"

namespace definite {

struct StableNeoHookeanLog {
  static constexpr std::string_view kName = "stable_neo_hookean_log";
  static constexpr std::string_view kSource = "Smith et al. 2018, Eq. 14";
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness of shape, times the rest volume"},
      {"lambda", 10.0, 2, "stiffness of volume, times the rest volume"},
  };
  static constexpr Stretchable kDomain = Stretchable::kAlways;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> x = Each(s, [](const T& si) { return si - T(1.0); });
    const T products = ProductsOf(x), change = Sum(x) + products;
    // (|F|^2 + 1)/(d + 1) = 1 + y; mu/2 (|F|^2 - d)/(d + 1) joins the logarithm.
    const T y = (T(2.0) * Sum(x) + Dot(x, x)) / T(D + 1.0);
    return MulAdd(p[0] * T(kG<D>), T(0.5) * Dot(x, x) - products,
                  T(0.5) * MulAdd(p[0], LessLog(y, y + T(1.0)), p[1] * change * change));
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const T pressure = Pressure(s, p), soft = Soft(s, p);
    Vec<T, D> slopes;
    for (int i = 0; i < D; ++i) slopes[i] = MulAdd(soft, s[i], pressure * OthersOf(s, i));
    return slopes;
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return MulAdd(Pressure(s, p), pair.third, Soft(s, p));
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return MulAdd(-Pressure(s, p), pair.third, Soft(s, p));
  }
  template <class T, int D>
  static PackedSym<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    const T pressure = Pressure(s, p), squares = Dot(s, s) + T(1.0);
    const T h = T(2.0) * p[0] / (squares * squares);
    return SymmetricOf<D>([&](int i, int j) {
      const T both = MulAdd(h, s[i] * s[j], p[1] * OthersOf(s, i) * OthersOf(s, j));
      return i == j ? both + Soft(s, p)
                    : MulAdd(pressure, StableNeoHookean::ThirdOf(s, i, j), both);
    });
  }

 private:
  template <int D>
  static constexpr double kG = D / (D + 1.0);

  template <class T, int D>
  static T Pressure(const Vec<T, D>& s, const T* p) {
    return MulAdd(p[1], Product(s) - T(1.0), -(p[0] * T(kG<D>)));
  }
  // mu |F|^2/(|F|^2 + 1): stiffness that goes with the element.
  template <class T, int D>
  static T Soft(const Vec<T, D>& s, const T* p) {
    const T squares = Dot(s, s);
    return p[0] * squares / (squares + T(1.0));
  }
};

DEFINITE_ENERGY(Distortion<Triangle, StableNeoHookeanLog>);
DEFINITE_ENERGY(Distortion<Tetrahedron, StableNeoHookeanLog>);

}  // namespace definite
