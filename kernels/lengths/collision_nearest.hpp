#pragma once

// The nearest PSD matrix to the Hessian of psi(l), for every length with a frame.
//
// Source: docs/derivations.md, section 2. In the orthonormal vectors v_k (x) n, (w/|w|) (x) u_k of
// the split set and the rest of w along n, the Hessian is a matrix of 2 S + 1 rows, S the number of
// tangents that may be free: at most 5. A fixed tangent is an eigenvector of its own.
// Shapes and units: as in collision_frame.hpp; all of the result's weights are >= 0.

#include "kernels/core/jacobi.hpp"
#include "kernels/lengths/collision_frame.hpp"

namespace definite {

// f from TurnedInX. kSlots >= 1.
template <Tangents kTangents, class T, int kVertices, int kSlots>
DEFINITE_INLINE auto NearestModes(const CollisionFrame<T, kVertices, kSlots>& f, const T& psi1,
                                  const T& psi2) {
  constexpr int kSize = 2 * kSlots + 1, kFixed = 2 - kSlots;
  const T width2 = Dot(f.w, f.w), width = Sqrt(width2), inverse_width = T(1.0) / width;
  T a[kSize][kSize];
  for (int i = 0; i < kSize; ++i) {
    for (int j = i; j < kSize; ++j) a[i][j] = T(0.0);
  }
  Vec<T, kVertices> v[kSlots + 1];
  T z[kSlots + 1];  // w in terms of the v
  v[kSlots] = f.w;
#pragma GCC unroll 2
  for (int k = 0; k < kSlots; ++k) {
    T present = inverse_width;
    if (kTangents.of[k] == Tangent::kByRegion) present = Select(f.fixed[k], T(0.0), present);
    v[k] = present * f.rows[k];
    z[k] = Dot(f.w, v[k]);
    v[kSlots] = v[kSlots] - z[k] * v[k];
    const T sigma = f.inverse_length[k] * width;
    const T slope = psi1 * sigma;
    a[k][k] = -(slope * f.l * sigma);
    a[k][kSlots + 1 + k] = -(slope * width);
    if (kTangents.of[k] == Tangent::kByRegion) {
      a[k][k] = Select(f.fixed[k], T(0.0), a[k][k]);
      a[k][kSlots + 1 + k] = Select(f.fixed[k], T(0.0), a[k][kSlots + 1 + k]);
      a[kSlots + 1 + k][kSlots + 1 + k] = Select(f.fixed[k], psi1 / f.l * width2, T(0.0));
    }
  }
  z[kSlots] = Sqrt(Dot(v[kSlots], v[kSlots]));
  v[kSlots] = (T(1.0) / z[kSlots]) * v[kSlots];
  for (int i = 0; i <= kSlots; ++i) {
    for (int j = i; j <= kSlots; ++j) a[i][j] = MulAdd(psi2 * z[i], z[j], a[i][j]);
  }

  const EigenSystem<T, kSize> e = JacobiEigen(a);
  Modes<T, 3 * kVertices, kSize + kFixed> modes;
  const auto positive = [](const T& lambda) { return Select(lambda < T(0.0), T(0.0), lambda); };
  for (int m = 0; m < kSize; ++m) {
    modes.lambda[m] = positive(e.values[m]);
    Vec<T, kVertices> along_n = e.vectors[0][m] * v[0];
    for (int k = 1; k <= kSlots; ++k) along_n = along_n + e.vectors[k][m] * v[k];
    Vec3<T> tangent = (e.vectors[kSlots + 1][m] * inverse_width) * f.t[0];
    if constexpr (kSlots == 2) {
      tangent = tangent + (e.vectors[kSlots + 2][m] * inverse_width) * f.t[1];
    }
    modes.v[m] = AddKron(Kron(f.w, tangent), along_n, f.n);
  }
  if constexpr (kFixed == 1) {
    modes.lambda[kSize] = positive(psi1 / f.l);
    modes.v[kSize] = Kron(f.w, f.t[1]);
  }
  return modes;
}

}  // namespace definite
