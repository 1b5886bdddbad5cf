#pragma once

// A symmetric matrix applied to a vector, without forming it where it is a sum of modes.

#include "kernels/kernel.hpp"

namespace definite {

// F d.
template <class T, int D, int K>
DEFINITE_INLINE Vec<T, D> Applied(const Modes<T, D, K>& modes, const Vec<T, D>& d) {
  Vec<T, D> y;
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) {
    const T along = modes.lambda[m] * Dot(modes.v[m], d);
#pragma GCC unroll 16
    for (int i = 0; i < D; ++i) {
      y[i] = m == 0 ? along * modes.v[m][i] : MulAdd(along, modes.v[m][i], y[i]);
    }
  }
  return y;
}
template <class T, int D>
DEFINITE_INLINE Vec<T, D> Applied(const PackedSym<T, D>& h, const Vec<T, D>& d) {
  Vec<T, D> y;
#pragma GCC unroll 16
  for (int i = 0; i < D; ++i) {
#pragma GCC unroll 16
    for (int j = 0; j < D; ++j) {
      const T& entry = h.a[internal::PackedIndex(i < j ? i : j, i < j ? j : i, D)];
      y[i] = j == 0 ? entry * d[j] : MulAdd(entry, d[j], y[i]);
    }
  }
  return y;
}
}  // namespace definite
