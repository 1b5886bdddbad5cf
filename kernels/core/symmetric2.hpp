#pragma once

// The eigensystem of a symmetric 2x2 matrix.

#include "kernels/core/mathfun.hpp"

namespace definite {

// Of [[a, b], [b, d]]: `first` belongs to (c, s), `second` to (-s, c), a unit vector.
template <class T>
struct Eigen2 {
  T first, second, c, s;
};

// One Jacobi rotation by the smaller angle. Diagonal matrices, zero too, are not turned.
template <class T>
DEFINITE_INLINE Eigen2<T> SymmetricEigen2(const T& a, const T& b, const T& d) {
  const T h = T(0.5) * (d - a);
  const T root = Sqrt(MulAdd(h, h, b * b));
  const T denominator = Abs(h) + root;
  const T magnitude = b / Select(denominator > T(0.0), denominator, T(1.0));
  const T t = Select(h < T(0.0), -magnitude, magnitude);
  const T c = T(1.0) / Sqrt(MulAdd(t, t, T(1.0)));
  return {a - t * b, d + t * b, c, -(t * c)};
}

}  // namespace definite
