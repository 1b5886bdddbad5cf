#pragma once

// psi(l) = k (l - eps)^2 for l < eps, else 0.
//
// Source: Shi & Kim 2023, Eq. 21.

#include "kernels/penalties/penalty.hpp"

namespace definite {

struct Quadratic {
  static constexpr std::string_view kName = "quadratic";
  static constexpr std::string_view kSource = "Eq. 21";
  static constexpr int kStiffnessPower = 0;
  static constexpr bool kOneSided = false;
  static constexpr std::array<Parameter, 0> kParameters{};

  template <class T>
  static DEFINITE_INLINE MaskOf<T> Outside(const T& l, const Vec<T, 2>&) {
    return l < l;
  }

  template <class T>
  static DEFINITE_INLINE T Value(const T& l, const Vec<T, 2>& p) {
    const T d = l - p[1];
    return p[0] * d * d;
  }

  template <class T>
  static DEFINITE_INLINE Slopes<T> Derivatives(const T& l, const Vec<T, 2>& p) {
    const T k2 = p[0] + p[0];
    return {k2 * (l - p[1]), k2};
  }
};

}  // namespace definite
