#pragma once

// psi(l) = k (l - eps)^2 for l < eps, else 0.
//
// Source: Shi & Kim 2023, Eq. 21.
// Contract of every penalty: on its active set psi' <= 0 and psi'' > 0 (it only ever repels), and
// psi is homogeneous in the lengths, so that Slopes may be given lengths in another unit.

#include <string_view>

#include "kernels/core/mathfun.hpp"

namespace definite {

struct Quadratic {
  static constexpr std::string_view kName = "quadratic";
  static constexpr std::string_view kSource = "Eq. 21";

  template <class T>
  struct Slopes {
    T psi1, psi2;
  };

  template <class T>
  static DEFINITE_INLINE T Value(const T& l, const T& k, const T& eps) {
    const T d = l - eps;
    return k * d * d;
  }

  // psi'(l)/unit and psi''(l) of a length `l unit`; degree 2, so the unit cancels.
  template <class T>
  static DEFINITE_INLINE Slopes<T> Derivatives(const T& l, const T& k, const T& eps) {
    const T k2 = k + k;
    return {k2 * (l - eps), k2};
  }
};

}  // namespace definite
