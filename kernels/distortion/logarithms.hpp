#pragma once

// Logarithms near 1, of s = 1 + x with both given: 1 + x would lose x, s - 1 a small s.

#include "kernels/core/precision.hpp"
#include "kernels/core/transcendental.hpp"

namespace definite {

// log s to rounding, near s = 1 too.
template <class T>
DEFINITE_INLINE T LogOf(const T& x, const T& s) {
  const auto near = Abs(x) < T(0.5);
  return Select(near, Log1p(Select(near, x, T(0.0))), Log(Select(near, T(1.0), s)));
}

// x - log s >= 0 to rounding.
template <class T>
DEFINITE_INLINE T LessLog(const T& x, const T& s) {
  // log s = 2 artanh r with r = x/(2 + x), and x - 2 r = x r: what is left is a short series.
  constexpr double kNear = 0.1;
  constexpr int kTerms = kUnitRoundoff<T> < 0x1p-60 ? 14 : 7;
  const auto near = Abs(x) < T(kNear);
  const T small = Select(near, x, T(0.0)), r = small / (T(2.0) + small), square = r * r;
  T series = T(1.0 / (2 * kTerms + 1));
  for (int k = kTerms - 1; k >= 1; --k) series = MulAdd(series, square, T(1.0) / T(2.0 * k + 1));
  const T far = x - Log(Select(near, T(1.0), s));
  return Select(near, r * (small - T(2.0) * (square * series)), far);
}

}  // namespace definite
