#pragma once

// A step towards a root of a polynomial that has real roots only: Laguerre's, of third order. From
// any point between the stationary points on both sides of a root it never passes the root.
//
// Source: Householder, The Numerical Treatment of a Single Nonlinear Equation, 1970, section 4.3.

#include "kernels/core/low_precision.hpp"

namespace definite {

// What the next step takes off x, on the way to the k-th root from below of
// x^N + c[N-1] x^(N-1) + ... + c[0]. With half of T's digits: it only starts an iteration, or comes
// on top of a better x.
template <int k, class T, int N>
DEFINITE_INLINE auto LaguerreStep(const T& x, const T (&c)[N]) {
  using Low = typename LowPrecision<T>::Type;
  T value = x + c[N - 1], slope = T(1.0f), half_bend = T(0.0f);
  bool first = true;
#pragma GCC unroll 8
  for (int i = N - 2; i >= 0; --i) {
    half_bend = first ? slope : MulAdd(half_bend, x, slope);
    slope = first ? x + value : MulAdd(slope, x, value);
    value = MulAdd(value, x, c[i]);
    first = false;
  }
  const Low p = LowOf(value), p1 = LowOf(slope), p2 = LowOf(half_bend);
  const Low square = MulAdd(p1, p1, Low(-2.0f * N / (N - 1)) * (p * p2));
  const Low root = Low(static_cast<float>(N - 1)) * Sqrt(Max(square, Low(0.0f)));
  // The slope's sign at the root is known.
  const Low denominator = (N - 1 - k) % 2 == 0 ? p1 + root : p1 - root;
  return (Low(static_cast<float>(N)) * p) / denominator;
}

}  // namespace definite
