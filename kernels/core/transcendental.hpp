#pragma once

// atan2 for every scalar type, by SLEEF's functions that give the same bits for one number as for
// lanes (1.0 ulp): `finz` with fused multiply-add, `cinz` without.

#include <sleef.h>

#include <cmath>

#include "kernels/core/lanes.hpp"

namespace definite {

DEFINITE_INLINE double Atan2(double y, double x) {
#if defined(__FMA__)
  return Sleef_finz_atan2d1_u10purecfma(y, x);
#else
  return Sleef_cinz_atan2d1_u10purec(y, x);
#endif
}

template <int W>
DEFINITE_INLINE Lanes<double, W> Atan2(const Lanes<double, W>& y, const Lanes<double, W>& x) {
#if defined(__AVX512F__)
  if constexpr (W == 8) {
    return internal::Wrap<Lanes<double, W>>(Sleef_finz_atan2d8_u10avx512f(y.lane, x.lane));
  }
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (W == 4) {
    return internal::Wrap<Lanes<double, W>>(Sleef_finz_atan2d4_u10avx2(y.lane, x.lane));
  }
#endif
  Lanes<double, W> r;
  for (int i = 0; i < W; ++i) r.lane[i] = Atan2(y.lane[i], x.lane[i]);
  return r;
}

template <class T>
T Atan2(const T& y, const T& x) {
  using std::atan2;
  return atan2(y, x);
}

}  // namespace definite
