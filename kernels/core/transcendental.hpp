#pragma once

// atan2, log and log1p for every scalar type, by SLEEF's functions that give the same bits for one
// number as for lanes (1.0 ulp): `finz` with fused multiply-add, `cinz` without.

#include <sleef.h>

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "kernels/core/lanes.hpp"

namespace definite {

// Name(arguments) for double and for lanes, by Sleef_..._function..._u10...
#if defined(__FMA__)
#define DEFINITE_SLEEF_SCALAR(function) Sleef_finz_##function##d1_u10purecfma
#else
#define DEFINITE_SLEEF_SCALAR(function) Sleef_cinz_##function##d1_u10purec
#endif

DEFINITE_INLINE double Atan2(double y, double x) { return DEFINITE_SLEEF_SCALAR(atan2)(y, x); }
DEFINITE_INLINE double Log(double x) { return DEFINITE_SLEEF_SCALAR(log)(x); }
DEFINITE_INLINE double Log1p(double x) { return DEFINITE_SLEEF_SCALAR(log1p)(x); }
#undef DEFINITE_SLEEF_SCALAR

namespace internal {

// One function over lanes: by the vector form where there is one, else lane by lane.
template <int W, class Eight, class Four, class One, class... L>
DEFINITE_INLINE Lanes<double, W> OverLanes(Eight eight, Four four, One one, const L&... x) {
  if constexpr (W == 8 && !std::is_same_v<Eight, std::nullptr_t>) {
    return Wrap<Lanes<double, W>>(eight(x.lane...));
  } else if constexpr (W == 4 && !std::is_same_v<Four, std::nullptr_t>) {
    return Wrap<Lanes<double, W>>(four(x.lane...));
  } else {
    Lanes<double, W> r;
    for (int i = 0; i < W; ++i) r.lane[i] = one(x.lane[i]...);
    return r;
  }
}

}  // namespace internal

#if defined(__AVX512F__)
#define DEFINITE_SLEEF_EIGHT(function) Sleef_finz_##function##d8_u10avx512f
#else
#define DEFINITE_SLEEF_EIGHT(function) nullptr
#endif
#if defined(__AVX2__) && defined(__FMA__)
#define DEFINITE_SLEEF_FOUR(function) Sleef_finz_##function##d4_u10avx2
#else
#define DEFINITE_SLEEF_FOUR(function) nullptr
#endif

template <int W>
DEFINITE_INLINE Lanes<double, W> Atan2(const Lanes<double, W>& y, const Lanes<double, W>& x) {
  return internal::OverLanes<W>(
      DEFINITE_SLEEF_EIGHT(atan2), DEFINITE_SLEEF_FOUR(atan2),
      [](double a, double b) { return Atan2(a, b); }, y, x);
}
template <int W>
DEFINITE_INLINE Lanes<double, W> Log(const Lanes<double, W>& x) {
  return internal::OverLanes<W>(
      DEFINITE_SLEEF_EIGHT(log), DEFINITE_SLEEF_FOUR(log), [](double a) { return Log(a); }, x);
}
template <int W>
DEFINITE_INLINE Lanes<double, W> Log1p(const Lanes<double, W>& x) {
  return internal::OverLanes<W>(
      DEFINITE_SLEEF_EIGHT(log1p), DEFINITE_SLEEF_FOUR(log1p), [](double a) { return Log1p(a); },
      x);
}
#undef DEFINITE_SLEEF_EIGHT
#undef DEFINITE_SLEEF_FOUR

template <class T>
T Atan2(const T& y, const T& x) {
  using std::atan2;
  return atan2(y, x);
}
template <class T>
T Log(const T& x) {
  using std::log;
  return log(x);
}
template <class T>
T Log1p(const T& x) {
  using std::log1p;
  return log1p(x);
}

}  // namespace definite
