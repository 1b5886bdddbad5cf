#pragma once

// psi(l) = k (l - eps)^2 sqrt((l - eps)^2 + delta) for l < eps, else 0: a spring that stiffens with
// its load.
//
// Domain: delta >= 0.
// Source: Shi & Kim 2023, Eqs. 26-29, after Gast et al. 2015.

#include "kernels/penalties/penalty.hpp"

namespace definite {

struct Cubic {
  static constexpr std::string_view kName = "cubic";
  static constexpr std::string_view kSource = "Eq. 26";
  static constexpr int kStiffnessPower = -1;
  static constexpr bool kOneSided = false;
  static constexpr std::array kParameters = {
      Parameter{"delta", 1e-4, 2, "keeps the root smooth, a squared length"}};

  template <class T>
  static DEFINITE_INLINE MaskOf<T> Outside(const T&, const Vec<T, 3>& p) {
    return p[2] < T(0.0);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const T& l, const Vec<T, 3>& p) {
    const T d = l - p[1], d2 = d * d;
    return p[0] * d2 * Sqrt(d2 + p[2]);
  }

  template <class T>
  static DEFINITE_INLINE Slopes<T> Derivatives(const T& l, const Vec<T, 3>& p) {
    const T d = l - p[1], d2 = d * d, delta = p[2], sum = d2 + delta;
    const T over_root = p[0] / Sqrt(sum);
    // (6 d^4 + 9 delta d^2 + 2 delta^2) / sum, in parts that neither over- nor underflow.
    const T part = delta / sum;
    return {over_root * d * MulAdd(T(3.0), d2, delta + delta),
            over_root * MulAdd(T(6.0), d2, part * MulAdd(T(3.0), d2, delta + delta))};
  }
};

}  // namespace definite
