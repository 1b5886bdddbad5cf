#pragma once

// F = U diag(s) V^T with U and V rotations and s1 >= s2 >= |s3|: the smallest stretch has the sign
// of det F, so that U V^T is the rotation closest to F.
//
// Source: one-sided Jacobi (Hestenes); U and the sign by Gram-Schmidt and a cross product, after
// McAdams et al. 2011.
// Differs: exact angles, a fixed number of sweeps, no branches; scalar and lanes agree bit for bit.
// Domain: every finite F whose largest entry exceeds 2^-1000; zero gives U = 1 and s = 0.
// Bound: residual and orthogonality at most 50 u (tests/svd_test.cpp), of the largest entry: small
// stretches are not accurate relative to themselves.

#include "kernels/core/precision.hpp"
#include "kernels/core/symmetric2.hpp"
#include "kernels/core/vec.hpp"

namespace definite {

// Columns of U and V.
template <class T, int D>
struct RotationSvd {
  Vec<T, D> u[D], s, v[D];
};

// Turns columns p and q of F V and of V so that those of F V become orthogonal.
template <class T, int D>
DEFINITE_INLINE void TurnColumns(Vec<T, D> (&b)[D], Vec<T, D> (&v)[D], int p, int q) {
  const auto e = SymmetricEigen2(Dot(b[p], b[p]), Dot(b[p], b[q]), Dot(b[q], b[q]));
  for (Vec<T, D>* m : {b, v}) {
    const Vec<T, D> first = e.c * m[p] + e.s * m[q];
    m[q] = e.c * m[q] - e.s * m[p];
    m[p] = first;
  }
}

// The longer column of F V first; V stays a rotation.
template <class T, int D>
DEFINITE_INLINE void SortColumns(Vec<T, D> (&b)[D], Vec<T, D> (&v)[D], int p, int q) {
  const auto swap = Dot(b[p], b[p]) < Dot(b[q], b[q]);
  for (Vec<T, D>* m : {b, v}) {
    const Vec<T, D> first = SelectAll<T, D>(swap, m[q], m[p]);
    m[q] = SelectAll<T, D>(swap, T(-1.0) * m[p], m[q]);
    m[p] = first;
  }
}

// Each squares what is left; with one less in double, tests/svd_test.cpp fails.
template <class T>
inline constexpr int kSvdSweeps = kUnitRoundoff<T> < 0x1p-60 ? 6 : 4;

// f: the columns of F.
template <class T, int D>
RotationSvd<T, D> SvdOf(const Vec<T, D> (&f)[D]) {
  static_assert(D == 2 || D == 3);
  RotationSvd<T, D> r;
  Vec<T, D> b[D];
  T magnitude = T(0x1p-1000);
  for (int j = 0; j < D; ++j) {
    for (int i = 0; i < D; ++i) {
      magnitude = Max(Abs(f[j][i]), magnitude);
      r.v[j][i] = T(i == j ? 1.0 : 0.0);
    }
  }
  // A power of two keeps the squares in range.
  const T scale = InversePowerOfTwo(magnitude);
  for (int j = 0; j < D; ++j) b[j] = scale * f[j];
  if constexpr (D == 2) {
    TurnColumns(b, r.v, 0, 1);  // one rotation is exact
    SortColumns(b, r.v, 0, 1);
  } else {
    for (int sweep = 0; sweep < kSvdSweeps<T>; ++sweep) {
      TurnColumns(b, r.v, 0, 1);
      TurnColumns(b, r.v, 0, 2);
      TurnColumns(b, r.v, 1, 2);
    }
    SortColumns(b, r.v, 0, 1);
    SortColumns(b, r.v, 0, 2);
    SortColumns(b, r.v, 1, 2);
  }
  const T s1 = Sqrt(Dot(b[0], b[0]));
  const auto zero = s1 <= T(0.0);
  const T inverse = T(1.0) / Select(zero, T(1.0), s1);
  for (int i = 0; i < D; ++i) r.u[0][i] = Select(zero, T(i == 0 ? 1.0 : 0.0), inverse * b[0][i]);
  r.s[0] = s1;
  T last;
  if constexpr (D == 2) {
    r.u[1] = {-r.u[0][1], r.u[0][0]};
    last = Dot(r.u[1], b[1]);
  } else {
    // Where there is no second direction, a unit vector well off the first.
    Vec<T, 3> w = b[1] - Dot(r.u[0], b[1]) * r.u[0];
    const T length = Sqrt(Dot(w, w));
    const auto line = length <= T(kUnitRoundoff<T>) * s1;
    const auto along_x = r.u[0][0] * r.u[0][0] > T(0.5);
    const Vec<T, 3> off = {Select(along_x, T(0.0), T(1.0)), Select(along_x, T(1.0), T(0.0)),
                           T(0.0)};
    const T unit = T(1.0) / Select(line, T(1.0), length);
    w = SelectAll<T, 3>(line, off, unit * w);
    w = w - Dot(r.u[0], w) * r.u[0];
    r.u[1] = (T(1.0) / Sqrt(Dot(w, w))) * w;
    r.u[2] = Cross(r.u[0], r.u[1]);
    // Rounding must not change the order; nor is the second stretch negative.
    r.s[1] = Select(line, Abs(Dot(r.u[1], b[1])), Dot(r.u[1], b[1]));
    r.s[1] = Min(r.s[1], s1);
    last = Dot(r.u[2], b[2]);
  }
  const T most = r.s[D - 2];
  last = Select(last > most, most, last);
  r.s[D - 1] = Select(last < -most, -most, last);
  const T back = T(1.0) / scale;
  r.s = back * r.s;
  return r;
}

}  // namespace definite
