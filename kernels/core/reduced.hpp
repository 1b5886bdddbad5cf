#pragma once

// A Hessian in the range it has: a small dense matrix in an orthonormal basis.
//
// Source: docs/derivations.md, section 1, for the orthogonal modes.

#include "kernels/kernel.hpp"

namespace definite {

// H = sum_ij h_ij basis[i] basis[j]^T.
template <class T, int D, int K>
struct Reduced {
  Vec<T, D> basis[K];
  PackedSym<T, K> h;
};

// Of modes that are orthogonal but for the first (Set::kSplit): these scaled to length one, and
// then what the first has besides (Gram-Schmidt, twice).
template <class T, int D, int K>
Reduced<T, D, K> Reduce(const Modes<T, D, K>& modes) {
  Reduced<T, D, K> r;
  const auto normalise = [](const Vec<T, D>& v, const T& norm) {
    const auto none = norm <= T(0.0);
    return Select(none, T(0.0), T(1.0)) / Select(none, T(1.0), norm) * v;
  };
  T z[K], diagonal[K];  // modes.v[0] = sum_i z[i] basis[i]
  for (int i = 0; i < K - 1; ++i) {
    const T square = Dot(modes.v[i + 1], modes.v[i + 1]);
    r.basis[i] = normalise(modes.v[i + 1], Sqrt(square));
    diagonal[i] = modes.lambda[i + 1] * square;
    z[i] = T(0.0);
  }
  Vec<T, D> rest = modes.v[0];
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < K - 1; ++i) {
      const T along = Dot(r.basis[i], rest);
      z[i] = z[i] + along;
      rest = rest - along * r.basis[i];
    }
  }
  z[K - 1] = Sqrt(Dot(rest, rest));
  r.basis[K - 1] = normalise(rest, z[K - 1]);
  diagonal[K - 1] = T(0.0);
  int k = 0;
  for (int i = 0; i < K; ++i) {
    const T weighted = modes.lambda[0] * z[i];
    r.h.a[k++] = MulAdd(weighted, z[i], diagonal[i]);
    for (int j = i + 1; j < K; ++j) r.h.a[k++] = weighted * z[j];
  }
  return r;
}

// sum_ij h_ij basis[i] basis[j]^T.
template <class T, int D, int K>
PackedSym<T, D> Lift(const Vec<T, D> (&basis)[K], const PackedSym<T, K>& h) {
  T full[K][K];
  int k = 0;
  for (int i = 0; i < K; ++i) {
    for (int j = i; j < K; ++j) full[i][j] = full[j][i] = h.a[k++];
  }
  Vec<T, D> rows[K];  // of h basis^T
  for (int i = 0; i < K; ++i) {
    rows[i] = full[i][0] * basis[0];
    for (int j = 1; j < K; ++j) rows[i] = rows[i] + full[i][j] * basis[j];
  }
  PackedSym<T, D> lifted;
  k = 0;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j, ++k) {
      lifted.a[k] = basis[0][i] * rows[0][j];
      for (int m = 1; m < K; ++m) lifted.a[k] = MulAdd(basis[m][i], rows[m][j], lifted.a[k]);
    }
  }
  return lifted;
}

}  // namespace definite
