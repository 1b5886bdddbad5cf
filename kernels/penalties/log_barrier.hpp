#pragma once

// psi(l) = -k (l - eps)^2 ln(l / eps) for 0 < l < eps, 0 beyond; not defined for l <= 0.
//
// Source: Shi & Kim 2023, Eqs. 30-33, after Li et al. 2020. Erratum: Eqs. 31 and 32 lack a factor l
// at the logarithm.
// Domain: l >= 1e-150 eps; below, psi'' ~ k eps^2 / l^2 cannot be represented.
// Differs: ln(l / eps) near l = eps from eps - l, which is exact there.

#include "kernels/core/transcendental.hpp"
#include "kernels/penalties/penalty.hpp"

namespace definite {

struct LogBarrier {
  static constexpr std::string_view kName = "log_barrier";
  static constexpr std::string_view kSource = "Eq. 30";
  static constexpr int kStiffnessPower = 0;
  static constexpr bool kOneSided = true;
  static constexpr std::array<Parameter, 0> kParameters{};

  template <class T>
  static DEFINITE_INLINE MaskOf<T> Outside(const T& l, const Vec<T, 2>& p) {
    return l < T(1e-150) * p[1];
  }

  template <class T>
  static DEFINITE_INLINE T Value(const T& l, const Vec<T, 2>& p) {
    const T d = p[1] - l;
    return p[0] * d * d * MinusLog(l, p[1]);
  }

  template <class T>
  static DEFINITE_INLINE Slopes<T> Derivatives(const T& l, const Vec<T, 2>& p) {
    const T eps = p[1], d = eps - l, log2 = T(2.0) * MinusLog(l, eps);
    const T ratio = d / l;
    return {-(p[0] * d * (log2 + ratio)), p[0] * (ratio * (eps / l + T(3.0)) + log2)};
  }

 private:
  // -ln(l / eps) = -ln(1 - d / eps) with d = eps - l.
  template <class T>
  static DEFINITE_INLINE T MinusLog(const T& l, const T& eps) {
    const auto near = l > T(0.5) * eps;
    return -Select(near, Log1p((l - eps) / eps), Log(l / eps));
  }
};

}  // namespace definite
