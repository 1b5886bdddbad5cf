#pragma once

// A multiple of the identity added to a matrix.

#include "kernels/kernel.hpp"

namespace definite {

template <class T, int D>
PackedSym<T, D> AddToDiagonal(PackedSym<T, D> h, const T& shift) {
  for (int i = 0, k = 0; i < D; k += D - i, ++i) h.a[k] = h.a[k] + shift;
  return h;
}

}  // namespace definite
