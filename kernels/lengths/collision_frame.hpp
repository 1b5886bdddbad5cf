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

#include "kernels/core/precision.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// Whether a closest point moves along a tangent.
enum class Tangent { kFree, kFixed, kByRegion };
// Of both tangents of a length; a fixed one comes last.
struct Tangents {
  Tangent of[2];
};
inline constexpr Tangents kBothFree{{Tangent::kFree, Tangent::kFree}};
inline constexpr Tangents kBothFixed{{Tangent::kFixed, Tangent::kFixed}};
inline constexpr Tangents kFreeAndFixed{{Tangent::kFree, Tangent::kFixed}};
inline constexpr Tangents kBothByRegion{{Tangent::kByRegion, Tangent::kByRegion}};

// Of kVertices vertices. The frame coordinates c are kSlots edges, each the partner of a tangent,
// and then the vector between the closest points.
template <class T, int kVertices, int kSlots>
struct CollisionFrame {
  static constexpr int kFreeSlots = kSlots;
  static constexpr int kCoordinates = 3 * (kSlots + 1), kDofs = 3 * kVertices;
  T scale, lift;              // lengths below are in units of 1 / (scale lift)
  MaskOf<T> outside;          // not in the domain; the rest is then finite and meaningless
  T l;                        // the length, with its sign
  Vec3<T> n;                  // grad l = w (x) n, n a unit vector
  Vec<T, kVertices> w;        // for a vertex and a face (1, -barycentric coordinates)
  Vec3<T> t[2];               // unit tangents, normal to n and to each other
  Vec<T, kVertices> rows[2];  // the slots of the frame map: an edge in terms of the vertices
  T inverse_length[2];        // 1/len of the slots
  MaskOf<T> fixed[2];         // for Tangent::kByRegion
  T region;

  DEFINITE_INLINE T InUnits(const T& length) const { return length * lift * scale; }
  DEFINITE_INLINE T FromUnits(const T& length) const { return length / scale / lift; }
};

// Edges in units of a power of two near their largest component, so that nothing overflows on the
// way: components are at most 4, and the largest at least 2.
template <class Frame, class T, class... Edge>
DEFINITE_INLINE void Prescale(Frame& f, Vec3<T>& first, Edge&... others) {
  T largest[3];  // of each coordinate; a chain of nine would be the longest path of the kernel
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    largest[i] = Abs(first[i]);
    ((largest[i] = Max(largest[i], Abs(others[i]))), ...);
  }
  const T magnitude = Max(Max(largest[0], largest[1]), largest[2]);
  // Subnormal lengths are lifted first: they have no exponent to read.
  constexpr double kSmallestNormal = 0x1p-1022;
  f.lift = Select(magnitude < T(kSmallestNormal), T(0x1p54), T(1.0));
  f.scale = InversePowerOfTwo(Max(magnitude * f.lift, T(kSmallestNormal)));
  first = f.scale * (f.lift * first);
  ((others = f.scale * (f.lift * others)), ...);
}
template <class Frame, class T>
DEFINITE_INLINE void Prescale(Frame& f, Edges<T>& edges) {
  Prescale(f, edges.e0, edges.e1, edges.e2);
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
  plane.parallel = area2 <= Max(T(kTau * kTau) * (aa * Dot(e1, e1)), T(kLeastArea * kLeastArea));
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

// The axis that is farthest from n.
template <class T>
DEFINITE_INLINE Vec3<T> AxisOff(const Vec3<T>& n) {
  const T least = Min(Abs(n[0]), Min(Abs(n[1]), Abs(n[2])));
  Vec3<T> axis;
  T left = T(1.0);  // only one of several
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    axis[k] = Select(Abs(n[k]) <= least, left, T(0.0));
    left = left - axis[k];
  }
  return axis;
}

// A frame in the plane of e0 and e1, whose normal is `sign` times the plane's: both tangents free.
template <class Stencil, class T>
DEFINITE_INLINE void SetPlane(const Plane<T>& plane, const Edges<T>& edges, const T& sign,
                              CollisionFrame<T, 4, 2>& f) {
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

// One mode of the frame: sigma n in `slot` (none if negative), `tangent` in the last coordinates.
template <class T>
struct FrameMode {
  T lambda;
  int slot;
  T sigma;
  Vec3<T> tangent;
};
template <class T, int K, bool kHasSlots>
struct FrameModes {
  static constexpr bool kTurning = kHasSlots;  // some mode has a slot
  FrameMode<T> mode[K];
};

// The modes of psi(l): psi'' first, then one that is kept for each tangent, then one that is
// dropped for each that is not fixed. psi1 is psi'/unit and at most 0 (a penalty only repels).
template <Part kPart, Tangents kTangents, class T, int kVertices, int kSlots>
DEFINITE_INLINE auto PairModes(const CollisionFrame<T, kVertices, kSlots>& f, const T& psi1,
                               const T& psi2) {
  constexpr int kTurning =
      (kTangents.of[0] != Tangent::kFixed) + (kTangents.of[1] != Tangent::kFixed);
  constexpr int kCount = kPart == Part::kCurvature ? 1 : kPart == Part::kAll ? 3 + kTurning : 3;
  FrameModes<T, kCount, kPart != Part::kCurvature && kTurning != 0> modes;
  modes.mode[0] = {psi2, -1, T(0.0), f.n};
  if constexpr (kPart != Part::kCurvature) {
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      const bool turns = kTangents.of[i] != Tangent::kFixed;
      T kept = T(0.0), tau = T(0.0), dropped = T(0.0), minus_inverse_tau = T(0.0);
      if (turns) {
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
      if (!turns) {
        kept = psi1 / f.l;
      } else if (kTangents.of[i] == Tangent::kByRegion) {
        kept = Select(f.fixed[i], psi1 / f.l, kept);
        tau = Select(f.fixed[i], T(0.0), tau);
        dropped = Select(f.fixed[i], T(0.0), dropped);
      }
      modes.mode[1 + i] = {kept, turns ? i : -1, tau, f.t[i]};
      if constexpr (kPart == Part::kAll) {
        if (turns) modes.mode[3 + i] = {dropped, i, minus_inverse_tau, f.t[i]};
      }
    }
  }
  return modes;
}

// In x: q -> S^T q, block j is sigma S_ij n + w_j t.
template <class Stencil, class T, int kSlots, int K, bool kTurning>
DEFINITE_INLINE auto PullBack(const CollisionFrame<T, Stencil::kVertices, kSlots>& f,
                              const FrameModes<T, K, kTurning>& frame_modes) {
  FramedModes<T, Stencil, K, kTurning> modes;
  modes.w = OverEdges<Stencil>(f.w, 1.0);
  modes.n = f.n;
#pragma GCC unroll 8
  for (int m = 0; m < K; ++m) {
    const FrameMode<T>& q = frame_modes.mode[m];
    modes.lambda[m] = q.lambda;
    modes.t[m] = q.tangent;
    modes.turns[m] = q.slot >= 0;
    if (q.slot >= 0) modes.r[m] = OverEdges<Stencil>(q.sigma * f.rows[q.slot], 0.0);
  }
  return modes;
}

// A Hessian in the frame coordinates c with the map S to them (Eq. 19): modes as stacked vectors.
template <class T, int kVertices, int kSlots, int K, bool kTurning>
auto ToFrameTerm(const CollisionFrame<T, kVertices, kSlots>& f,
                 const FrameModes<T, K, kTurning>& frame_modes) {
  using Frame = CollisionFrame<T, kVertices, kSlots>;
  FrameTerm<T, Frame::kCoordinates, Frame::kDofs, K> term;
  for (int m = 0; m < K; ++m) {
    const FrameMode<T>& q = frame_modes.mode[m];
    term.modes.lambda[m] = q.lambda;
    for (int i = 0; i < 3; ++i) {
      for (int slot = 0; slot < kSlots; ++slot) {
        term.modes.v[m][3 * slot + i] = q.slot == slot ? q.sigma * f.n[i] : T(0.0);
      }
      term.modes.v[m][3 * kSlots + i] = q.tangent[i];
    }
  }
  for (int slot = 0; slot <= kSlots; ++slot) {
    const Vec<T, kVertices>& row = slot < kSlots ? f.rows[slot] : f.w;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < Frame::kDofs; ++j) {
        term.map[3 * slot + i][j] = j % 3 == i ? row[j / 3] : T(0.0);
      }
    }
  }
  return term;
}

// The free tangents of a frame and their rows over lengths, rows[i] / len_i, turned so that the
// rows are orthogonal: sum_i rows[i] t[i]^T / len_i = sum_k sigma[k] v[k] t[k]^T, the singular
// value decomposition. sigma descends.
template <class T, int kVertices, int kSlots>
struct TurnedRows {
  Vec<T, kVertices> v[kSlots];  // unit rows; zero where the tangent is fixed
  T sigma[kSlots];
  Vec3<T> t[kSlots];
};

// kGramDeterminant: |rows[0]|^2 |rows[1]|^2 - (rows[0] . rows[1])^2, a constant of the stencil.
// Source: docs/derivations.md, section 1.
template <Tangents kTangents, int kGramDeterminant, class T, int kVertices, int kSlots>
requires(kSlots > 0) DEFINITE_INLINE TurnedRows<T, kVertices, kSlots> TurnedRowsOf(
    const CollisionFrame<T, kVertices, kSlots>& f) {
  TurnedRows<T, kVertices, kSlots> turned;
  if constexpr (kSlots == 1) {
    const T length2 = Dot(f.rows[0], f.rows[0]), inverse = T(1.0) / Sqrt(length2);
    turned.v[0] = inverse * f.rows[0];
    turned.sigma[0] = f.inverse_length[0] * (length2 * inverse);
    turned.t[0] = f.t[0];
  } else {
    T inverse[2] = {f.inverse_length[0], f.inverse_length[1]};
    if constexpr (kTangents.of[0] == Tangent::kByRegion) {
      for (int i = 0; i < 2; ++i) inverse[i] = Select(f.fixed[i], T(0.0), inverse[i]);
    }
    const Vec<T, kVertices> g0 = inverse[0] * f.rows[0], g1 = inverse[1] * f.rows[1];
    const T m00 = Dot(g0, g0), m01 = Dot(g0, g1), m11 = Dot(g1, g1);
    const T half = T(0.5) * (m00 - m11);
    const T root = Sqrt(MulAdd(half, half, m01 * m01));
    const T larger2 = T(0.5) * (m00 + m11) + root;
    // None free, or one: then the smaller is zero, and its row too.
    const T square = Select(larger2 <= T(0.0), T(1.0), larger2);
    const T inverse_larger = T(1.0) / Sqrt(square);
    const T area = ConstantRoot<T>::Of(kGramDeterminant) * (inverse[0] * inverse[1]);
    turned.sigma[0] = larger2 * inverse_larger;
    turned.sigma[1] = area * inverse_larger;  // from the determinant, without cancellation
    // (c, s) belongs to the larger one.
    const T along = Abs(half) + root;
    const T norm2 = MulAdd(along, along, m01 * m01);
    const T norm = T(1.0) / Sqrt(Select(norm2 <= T(0.0), T(1.0), norm2));
    const T cosine = Select(norm2 <= T(0.0), T(1.0), along * norm), sine = m01 * norm;
    const auto swapped = half < T(0.0);
    const T c = Select(swapped, sine, cosine), s = Select(swapped, cosine, sine);
    turned.t[0] = c * f.t[0] + s * f.t[1];
    turned.t[1] = c * f.t[1] - s * f.t[0];
    turned.v[0] = inverse_larger * (c * g0 + s * g1);
    const T inverse_smaller = turned.sigma[0] / Select(area <= T(0.0), T(1.0), area);
    turned.v[1] = inverse_smaller * (c * g1 - s * g0);
  }
  return turned;
}

// The same geometric term in orthogonal vectors of x: as a frame whose rows are as long as w.
template <Tangents kTangents, int kGramDeterminant, class T, int kVertices, int kSlots>
DEFINITE_INLINE CollisionFrame<T, kVertices, kSlots> TurnedInX(
    CollisionFrame<T, kVertices, kSlots> f) {
  if constexpr (kTangents.of[0] != Tangent::kFixed) {
    const auto turned = TurnedRowsOf<kTangents, kGramDeterminant>(f);
    const T width2 = Dot(f.w, f.w), inverse_width = T(1.0) / Sqrt(width2);
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      f.rows[k] = (width2 * inverse_width) * turned.v[k];
      f.inverse_length[k] = turned.sigma[k] * inverse_width;
      f.t[k] = turned.t[k];
    }
  }
  return f;
}

}  // namespace definite
