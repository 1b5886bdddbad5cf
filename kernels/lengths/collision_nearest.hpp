#pragma once

// The nearest PSD matrix to the Hessian of psi(l), for every length with a frame.
//
// Source: docs/derivations.md, section 2. In the orthonormal vectors v_k (x) n, (w/|w|) (x) u_k of
// the split set and the rest of w along n, the Hessian is a matrix of 2 S + 1 rows, S the number of
// tangents that may be free: 2x2 blocks with known eigenvalues, and psi'' z z^T. Its S + 1 positive
// eigenvalues are roots of a secular equation; the result is made of them alone, so that it is PSD
// by construction and its error relative to itself, however large what is dropped. A fixed tangent
// is an eigenvector of its own.
// Shapes and units: as in collision_frame.hpp; all of the result's weights are >= 0.

#include "kernels/core/secular.hpp"
#include "kernels/lengths/collision_frame.hpp"

namespace definite {

// What is left of w beside the rows v of a frame. If both slots are free these span all rows that
// sum to zero but one, and the rest is a constant of the stencil: a difference would lose digits
// where the foot point is far away.
template <class Stencil, bool kConstant, class T, int kVertices, int kSlots>
DEFINITE_INLINE Vec<T, kVertices> RestOfRow(const Vec<T, kVertices>& w,
                                            const Vec<T, kVertices> (&v)[kSlots],
                                            const T (&s)[kSlots]) {
  if constexpr (kConstant) {
    return Stencil::template RestRow<T>();
  } else {
    Vec<T, kVertices> rest = w;
    for (int k = 0; k < kSlots; ++k) rest = rest - s[k] * v[k];
    return rest;
  }
}

// f from TurnedInX. kSlots >= 1.
template <class Stencil, Tangents kTangents, class T, int kVertices, int kSlots>
DEFINITE_INLINE auto NearestModes(const CollisionFrame<T, kVertices, kSlots>& f, const T& psi1,
                                  const T& psi2) {
  constexpr bool kByRegion = kTangents.of[0] == Tangent::kByRegion;
  constexpr int kPoles = 2 * kSlots + 1, kRoots = kSlots + 1;
  constexpr int kFixed = kByRegion ? 2 : 2 - kSlots;  // tangents that may be fixed
  // Below these a number is replaced by them: the Hessian changes by less than a rounding error,
  // and no pole has weight zero or meets another one.
  constexpr double kLeastBlock = 1e-30, kLeastCurvature = 1e-34, kLeastCosine = 1e-17;
  constexpr double kApart = 0x1p-50;

  const T width2 = Dot(f.w, f.w), width = Sqrt(width2), inverse_width = T(1.0) / width;
  const T inverse_unit = InversePowerOfTwo(
      Max(Max(Abs(psi1 * f.inverse_length[0] * width2),
              Abs((psi1 * f.inverse_length[0]) * (f.l * f.inverse_length[0]) * width2)),
          Max(psi2 * width2, T(0x1p-1000))));
  const T slope = psi1 * inverse_unit;
  const T curvature = Max(psi2 * inverse_unit, T(kLeastCurvature));

  Vec<T, kVertices> v[kSlots];
  T s[kSlots], block[kSlots];  // w . v_k, and the entry of w (x) u_k with v_k (x) n
  SecularEquation<T, kPoles> equation;
  auto& d = equation.pole;
#pragma GCC unroll 2
  for (int k = 0; k < kSlots; ++k) {
    T present = inverse_width;
    if constexpr (kByRegion) present = Select(f.fixed[k], T(0.0), present);
    v[k] = present * f.rows[k];
    s[k] = Dot(f.w, v[k]);
    s[k] = Select(Abs(s[k]) < T(kLeastCosine), T(kLeastCosine), s[k]);
    T sigma = f.inverse_length[k] * width;
    if constexpr (kByRegion) sigma = Select(f.fixed[k], T(0.0), sigma);
    const T of_n = T(-0.5) * (slope * sigma) * (f.l * sigma);
    block[k] = -(slope * sigma) * width;
    block[k] = Select(Abs(block[k]) < T(kLeastBlock), T(kLeastBlock), block[k]);
    const T square = block[k] * block[k];
    const T root = Sqrt(MulAdd(of_n, of_n, square));
    const T larger = Abs(of_n) + root, smaller = square / larger;
    const auto down = of_n < T(0.0);
    const T plus = Select(down, smaller, larger), minus = Select(down, larger, smaller);
    // Poles ascend from the first slot's negative one, for its sigma is the larger.
    d[k] = -minus;
    d[kPoles - 1 - k] = plus;
    const T weight = curvature * (s[k] * s[k]) / (root + root);
    equation.weight[k] = weight * minus;
    equation.weight[kPoles - 1 - k] = weight * plus;
  }
  const Vec<T, kVertices> rest = RestOfRow<Stencil, !kByRegion>(f.w, v, s);
  const T rest2 = Dot(rest, rest);
  d[kSlots] = T(0.0);
  equation.weight[kSlots] = curvature * rest2;
  if constexpr (kSlots == 2) d[3] = Min(d[3], d[4] - T(kApart) * d[4]);

  const auto roots = equation.template LargestRoots<kRoots>();

  Modes<T, 3 * kVertices, kRoots + kFixed> modes;
  const T unit = T(1.0) / inverse_unit;
  T along_n[kRoots][kSlots + 1], along_u[kRoots][kSlots], squared[kRoots];
#pragma GCC unroll 3
  for (int m = kRoots - 1; m >= 0; --m) {
    // Scaled: the rest (x) n, and in each block (mu, B) mu s / ((d- - mu)(d+ - mu)).
    const auto& [mu, to_pole] = roots.root[m];
    along_n[m][kSlots] = T(1.0);
    for (int k = 0; k < kSlots; ++k) {
      const T part = s[k] * mu / (to_pole[k] * to_pole[kPoles - 1 - k]);
      along_n[m][k] = part * mu;
      along_u[m][k] = part * block[k];
    }
    // Where a weight is tiny and a root almost its pole, a pair of vectors spans the right plane
    // and need not be orthogonal.
    for (int other = kRoots - 1; other > m; --other) {
      T along = rest2 * (along_n[m][kSlots] * along_n[other][kSlots]);
      for (int k = 0; k < kSlots; ++k) {
        along = MulAdd(along_n[m][k], along_n[other][k], along);
        along = MulAdd(along_u[m][k], along_u[other][k], along);
      }
      along = along / squared[other];
      for (int k = 0; k <= kSlots; ++k) {
        along_n[m][k] = along_n[m][k] - along * along_n[other][k];
      }
      for (int k = 0; k < kSlots; ++k) {
        along_u[m][k] = along_u[m][k] - along * along_u[other][k];
      }
    }
    squared[m] = rest2 * (along_n[m][kSlots] * along_n[m][kSlots]);
    for (int k = 0; k < kSlots; ++k) {
      squared[m] = MulAdd(along_n[m][k], along_n[m][k], squared[m]);
      squared[m] = MulAdd(along_u[m][k], along_u[m][k], squared[m]);
    }
    modes.lambda[m] = unit * (mu / squared[m]);
    Vec<T, kVertices> of_n = along_n[m][kSlots] * rest;
    for (int k = 0; k < kSlots; ++k) of_n = of_n + along_n[m][k] * v[k];
    Vec3<T> tangent = (along_u[m][0] * inverse_width) * f.t[0];
    if constexpr (kSlots == 2) tangent = tangent + (along_u[m][1] * inverse_width) * f.t[1];
    modes.v[m] = AddKron(Kron(f.w, tangent), of_n, f.n);
  }
#pragma GCC unroll 2
  for (int i = 0; i < kFixed; ++i) {
    const int k = 2 - kFixed + i;
    const T lambda = psi1 / f.l;
    modes.lambda[kRoots + i] = Select(lambda < T(0.0), T(0.0), lambda);
    if constexpr (kByRegion) {
      modes.lambda[kRoots + i] = Select(f.fixed[k], modes.lambda[kRoots + i], T(0.0));
    }
    modes.v[kRoots + i] = Kron(f.w, f.t[k]);
  }
  return modes;
}

}  // namespace definite
