#pragma once

// Small fixed-size vectors over any scalar type.

#include <utility>

#include "kernels/core/mathfun.hpp"

namespace definite {

// What a comparison gives: bool, or a mask over lanes.
template <class T>
using MaskOf = decltype(std::declval<T>() <= std::declval<T>());

template <class T, int N>
struct Vec {
  T v[N];

  DEFINITE_INLINE T& operator[](int i) { return v[i]; }
  DEFINITE_INLINE const T& operator[](int i) const { return v[i]; }
};

template <class T>
using Vec3 = Vec<T, 3>;

template <class T, int N>
DEFINITE_INLINE Vec<T, N> operator+(const Vec<T, N>& a, const Vec<T, N>& b) {
  Vec<T, N> r;
#pragma GCC unroll 16
  for (int i = 0; i < N; ++i) r[i] = a[i] + b[i];
  return r;
}

template <class T, int N>
DEFINITE_INLINE Vec<T, N> operator-(const Vec<T, N>& a, const Vec<T, N>& b) {
  Vec<T, N> r;
#pragma GCC unroll 16
  for (int i = 0; i < N; ++i) r[i] = a[i] - b[i];
  return r;
}

template <class T, int N>
DEFINITE_INLINE Vec<T, N> operator*(const T& s, const Vec<T, N>& a) {
  Vec<T, N> r;
#pragma GCC unroll 16
  for (int i = 0; i < N; ++i) r[i] = s * a[i];
  return r;
}

template <class T, int N>
DEFINITE_INLINE T Dot(const Vec<T, N>& a, const Vec<T, N>& b) {
  T r = a[0] * b[0];
#pragma GCC unroll 16
  for (int i = 1; i < N; ++i) r = MulAdd(a[i], b[i], r);
  return r;
}

// Select, entry by entry.
template <class T, int N>
DEFINITE_INLINE Vec<T, N> SelectAll(const MaskOf<T>& mask, const Vec<T, N>& yes,
                                    const Vec<T, N>& no) {
  Vec<T, N> r;
#pragma GCC unroll 16
  for (int i = 0; i < N; ++i) r[i] = Select(mask, yes[i], no[i]);
  return r;
}

template <class T>
DEFINITE_INLINE Vec3<T> Cross(const Vec3<T>& a, const Vec3<T>& b) {
  // Products are rounded alike on both sides of each difference, so parallel vectors give exactly
  // 0.
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The same to a few units in the last place of each component, however much the products cancel
// (Kahan's difference of products). The plain one is off by a rounding error of the products, which
// of two almost parallel edges turns the normal towards them: where l is small as well, that is all
// that is left of it.
template <class T>
DEFINITE_INLINE Vec3<T> CarefulCross(const Vec3<T>& a, const Vec3<T>& b) {
  Vec3<T> r;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const T product = a[k] * b[j];
    r[i] = MulAdd(a[j], b[k], -product) + MulAdd(-a[k], b[j], product);
  }
  return r;
}

// Vertex j of a stacked vector of 3-vectors.
template <class T, int N>
DEFINITE_INLINE Vec3<T> Vertex(const Vec<T, N>& x, int j) {
  return {x[3 * j], x[3 * j + 1], x[3 * j + 2]};
}

// u (x) v, the Kronecker product of a row over vertices with a 3-vector: block j is u_j v.
template <class T, int N>
DEFINITE_INLINE Vec<T, 3 * N> Kron(const Vec<T, N>& u, const Vec3<T>& v) {
  Vec<T, 3 * N> r;
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
#pragma GCC unroll 16
    for (int k = 0; k < 3; ++k) r[3 * j + k] = u[j] * v[k];
  }
  return r;
}

// r + u (x) v.
template <class T, int N>
DEFINITE_INLINE Vec<T, 3 * N> AddKron(const Vec<T, 3 * N>& r, const Vec<T, N>& u,
                                      const Vec3<T>& v) {
  Vec<T, 3 * N> s;
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
#pragma GCC unroll 16
    for (int k = 0; k < 3; ++k) s[3 * j + k] = MulAdd(u[j], v[k], r[3 * j + k]);
  }
  return s;
}

// The three edges a collision length is made of.
template <class T>
struct Edges {
  Vec3<T> e0, e1, e2;
};

}  // namespace definite
