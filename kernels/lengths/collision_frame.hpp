#pragma once

// What every length between two primitives has in common: psi(l) of a length l that carries a sign,
// its reduced frame, and the modes of its Hessian.
//
// Source: Shi & Kim 2023, Eqs. 1-13, 16-19, 51-53.
// Differs: no e2perp and no division by l where a limit exists. Along a tangent t that is free (the
// closest point moves with it) the 2x2 block of the Hessian on (n in slot i, t in slot 2) is
//   psi' [[-l/len^2, -1/len], [-1/len, 0]],
// with eigenvectors (tau, 1) and (-1/tau, 1), tau = r + h, h = sqrt(1 + r^2), r = l/(2 len); scaled
// so, their weights are -psi'/(2 h len) and +psi'/(2 h len). Along a tangent that is fixed (the
// closest point is an endpoint, or its parameter is held constant) it is psi'/l on t alone. A
// length u >= 0 with a sign s enters as l = s u, so that one rule, active where l < eps, serves
// all: Eq. 25 as it should read.
// Shapes and units: x in any unit of length; weights of psi; frame rows and tangents free of units.

#include <utility>

#include "kernels/core/precision.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// Which tangents of a length are free.
enum class Tangents { kFree, kFixed, kByRegion };

template <class T>
struct CollisionFrame {
  T scale, lift;         // lengths below are in units of 1 / (scale lift)
  MaskOf<T> outside;     // not in the domain; the rest is then finite and meaningless
  T l;                   // the length, with its sign
  Vec3<T> n;             // grad l = w (x) n, n a unit vector
  Vec<T, 4> w;           // for a vertex and a face (1, -barycentric coordinates)
  Vec3<T> t[2];          // unit tangents, normal to n and to each other
  Vec<T, 4> rows[2];     // slots 0 and 1 of the frame map
  T inverse_length[2];   // 1/len of slots 0 and 1
  MaskOf<T> fixed[2];    // for Tangents::kByRegion
  T region;

  DEFINITE_INLINE T InUnits(const T& length) const { return length * lift * scale; }
  DEFINITE_INLINE T FromUnits(const T& length) const { return length / scale / lift; }
};

// Edges in units of a power of two near their largest component, so that nothing overflows on the
// way: components are at most 4, and the largest at least 2.
template <class T>
DEFINITE_INLINE void Prescale(Edges<T>& edges, CollisionFrame<T>& f) {
  auto& [e0, e1, e2] = edges;
  T largest[3];  // of each coordinate; a chain of nine would be the longest path of the kernel
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) largest[i] = Max(Max(Abs(e0[i]), Abs(e1[i])), Abs(e2[i]));
  const T magnitude = Max(Max(largest[0], largest[1]), largest[2]);
  // Subnormal lengths are lifted first: they have no exponent to read.
  constexpr double kSmallestNormal = 0x1p-1022;
  f.lift = Select(magnitude < T(kSmallestNormal), T(0x1p54), T(1.0));
  f.scale = InversePowerOfTwo(Max(magnitude * f.lift, T(kSmallestNormal)));
#pragma GCC unroll 3
  for (Vec3<T>* e : {&e0, &e1, &e2}) *e = f.scale * (f.lift * *e);
}

// The plane of e0 and e1.
template <class T>
struct Plane {
  MaskOf<T> parallel;      // no such plane; the rest is then finite and meaningless
  Vec3<T> normal, t0, t1;  // normal along e0 x e1, t0 along e0, t1 = normal x t0
  T inverse_a, inverse_b;  // 1/|e0| and 1/|e1 - alpha e0|
  T alpha, beta, gamma;    // of the frame, Eq. 2
};

template <class T>
DEFINITE_INLINE Plane<T> PlaneOf(const Edges<T>& edges) {
  const auto& [e0, e1, e2] = edges;
  Plane<T> plane;
  const Vec3<T> c = Cross(e0, e1);
  T area2 = Dot(c, c), aa = Dot(e0, e0);
  plane.parallel =
      area2 <= Max(T(kTau * kTau) * (aa * Dot(e1, e1)), T(kLeastArea * kLeastArea));
  area2 = Select(plane.parallel, T(1.0), area2);
  aa = Select(plane.parallel, T(1.0), aa);
  const T area = Sqrt(area2), a = Sqrt(aa);
  const T inverse_area = T(1.0) / area;
  plane.inverse_a = T(1.0) / a;
  plane.inverse_b = a * inverse_area;
  plane.normal = inverse_area * c;
  plane.t0 = plane.inverse_a * e0;
  plane.t1 = Cross(plane.normal, plane.t0);
  plane.alpha = Dot(plane.t0, e1) * plane.inverse_a;
  // From the in-plane dual basis: the printed quotients cancel like 1/sin^2.
  plane.beta = Dot(Cross(e1, plane.normal), e2) * inverse_area;
  plane.gamma = Dot(Cross(plane.normal, e0), e2) * inverse_area;
  return plane;
}

// A frame in the plane of e0 and e1, whose normal is `sign` times the plane's: both tangents free.
template <class Stencil, class T>
DEFINITE_INLINE void SetPlane(const Plane<T>& plane, const Edges<T>& edges, const T& sign,
                              CollisionFrame<T>& f) {
  f.n = sign * plane.normal;
  f.l = Dot(f.n, edges.e2);
  f.w = Stencil::Row2(plane.beta, plane.gamma);
  f.t[0] = plane.t0;
  f.t[1] = plane.t1;
  f.rows[0] = Stencil::template Row0<T>();
  f.rows[1] = Stencil::Row1(plane.alpha);
  f.inverse_length[0] = plane.inverse_a;
  f.inverse_length[1] = plane.inverse_b;
  f.region = T(0.0);
}

// One mode of the frame: sigma n in `slot` (0 or 1; none if negative) and `tangent` in slot 2.
template <class T>
struct FrameMode {
  T lambda;
  int slot;
  T sigma;
  Vec3<T> tangent;
};
template <class T, int K>
struct FrameModes {
  FrameMode<T> mode[K];
};

// The modes of psi(l): psi'' first, then a kept and a dropped one for each tangent. psi1 is
// psi'/unit and at most 0 (a penalty only repels).
template <Part kPart, Tangents kTangents, class T>
DEFINITE_INLINE auto PairModes(const CollisionFrame<T>& f, const T& psi1, const T& psi2) {
  // A fixed tangent has one mode, a free one two.
  constexpr bool kTurns = kTangents != Tangents::kFixed;
  constexpr bool kBoth = kPart == Part::kAll && kTurns;
  constexpr int kCount = kPart == Part::kCurvature ? 1 : kBoth ? 5 : 3;
  FrameModes<T, kCount> modes;
  modes.mode[0] = {psi2, -1, T(0.0), f.n};
  if constexpr (kPart != Part::kCurvature) {
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      T kept, tau, dropped = T(0.0), minus_inverse_tau = T(0.0);
      if constexpr (kTurns) {
        const T half = T(0.5) * f.inverse_length[i];
        const T r = f.l * half;
        const T h = Sqrt(MulAdd(r, r, T(1.0)));
        const T larger = h + Abs(r);
        const T inverse = T(1.0) / (h * larger);
        const T smaller = inverse * h;  // h - |r| without cancellation
        dropped = psi1 * half * (inverse * larger);
        kept = -dropped;
        tau = Select(r < T(0.0), smaller, larger);
        minus_inverse_tau = -Select(r < T(0.0), larger, smaller);
      }
      if constexpr (!kTurns) {
        kept = psi1 / f.l;
        tau = T(0.0);
      } else if constexpr (kTangents == Tangents::kByRegion) {
        kept = Select(f.fixed[i], psi1 / f.l, kept);
        tau = Select(f.fixed[i], T(0.0), tau);
        dropped = Select(f.fixed[i], T(0.0), dropped);
      }
      modes.mode[1 + i] = {kept, kTurns ? i : -1, tau, f.t[i]};
      if constexpr (kBoth) {
        modes.mode[3 + i] = {dropped, i, minus_inverse_tau, f.t[i]};
      }
    }
  }
  return modes;
}

// In x: q -> S^T q, block j is sigma S_ij n + w_j t.
template <class T, int K>
DEFINITE_INLINE Modes<T, 12, K> PullBack(const CollisionFrame<T>& f,
                                         const FrameModes<T, K>& frame_modes) {
  Modes<T, 12, K> modes;
#pragma GCC unroll 8
  for (int m = 0; m < K; ++m) {
    const FrameMode<T>& q = frame_modes.mode[m];
    modes.lambda[m] = q.lambda;
    modes.v[m] = Kron(f.w, q.tangent);
    if (q.slot >= 0) modes.v[m] = AddKron(modes.v[m], q.sigma * f.rows[q.slot], f.n);
  }
  return modes;
}

// In the frame coordinates c: the stacked vector of 9.
template <class T, int K>
DEFINITE_INLINE Modes<T, 9, K> InFrame(const CollisionFrame<T>& f,
                                       const FrameModes<T, K>& frame_modes) {
  Modes<T, 9, K> modes;
  for (int m = 0; m < K; ++m) {
    const FrameMode<T>& q = frame_modes.mode[m];
    modes.lambda[m] = q.lambda;
    for (int i = 0; i < 3; ++i) {
      modes.v[m][i] = q.slot == 0 ? q.sigma * f.n[i] : T(0.0);
      modes.v[m][3 + i] = q.slot == 1 ? q.sigma * f.n[i] : T(0.0);
      modes.v[m][6 + i] = q.tangent[i];
    }
  }
  return modes;
}

}  // namespace definite
