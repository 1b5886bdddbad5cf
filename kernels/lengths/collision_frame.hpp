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

// The frame coordinates c are kSlots edges, each the partner of a tangent, and then the vector
// between the closest points. Rows are over the edges of the stencil (framed_modes.hpp).
template <class T, class FrameStencil, int kSlots>
struct CollisionFrame {
  using Stencil = FrameStencil;
  using Row = Vec<T, Stencil::kEdges>;
  static constexpr int kFreeSlots = kSlots;
  T scale, lift;        // lengths below are in units of 1 / (scale lift)
  MaskOf<T> outside;    // not in the domain; the rest is then finite and meaningless
  T l;                  // the length, with its sign
  Vec3<T> n;            // grad l = w (x) n, n a unit vector
  Row w;                // of the last edge, which joins the primitives, 1
  Vec3<T> t[2];         // unit tangents, normal to n and to each other
  Row rows[2];          // the slots of the frame map; of the last edge 0
  T inverse_length[2];  // 1/len of the slots
  MaskOf<T> fixed[2];   // for Tangent::kByRegion
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
  T magnitude = Max(Max(largest[0], largest[1]), largest[2]);
  f.lift = T(1.0);
  // Subnormal lengths are lifted first: they have no exponent to read. A branch, since the scale is
  // on the longest path of the kernel.
  constexpr double kSmallestNormal = 0x1p-1022;
  const auto subnormal = magnitude < T(kSmallestNormal);
  if (Any(subnormal)) [[unlikely]] {
    f.lift = Select(subnormal, T(0x1p54), T(1.0));
    magnitude = magnitude * f.lift;
    first = f.lift * first;
    ((others = f.lift * others), ...);
  }
  f.scale = InversePowerOfTwo(Max(magnitude, T(kSmallestNormal)));  // of zero, and of NaN
  first = f.scale * first;
  ((others = f.scale * others), ...);
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
  const Vec3<T> c = CarefulCross(e0, e1);
  const T area2 = Dot(c, c), aa = Dot(e0, e0), bb = Dot(e1, e1);
  const T least = Max(T(kTau * kTau) * (aa * bb), T(kLeastArea * kLeastArea));
  plane.parallel = (area2 <= least) | (Min(aa, bb) <= T(kLeastEdge * kLeastEdge));
  const T area = Sqrt(Max(area2, least)), a = Sqrt(Max(aa, T(kLeastEdge * kLeastEdge)));
  const T inverse_area = T(1.0) / area;
  plane.inverse_a = T(1.0) / a;
  plane.inverse_b = a * inverse_area;
  plane.normal = inverse_area * c;
  plane.t0 = plane.inverse_a * e0;
  plane.t1 = Cross(plane.normal, plane.t0);
  const T along = Dot(plane.t0, e1);
  plane.alpha = along * plane.inverse_a;
  // By the in-plane dual basis: the printed quotients cancel like 1/sin^2. On t0 and t1, e1 is
  // (along, b) and e2 is (x, y).
  const T b = area * plane.inverse_a, x = Dot(plane.t0, e2), y = Dot(plane.t1, e2);
  plane.beta = MulAdd(b, x, -(along * y)) * inverse_area;
  plane.gamma = y * plane.inverse_b;
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

// Rows of the frame map in such a plane, Eq. 19: c_i as a sum of edges.
template <class T>
struct PlaneRows {
  Vec3<T> c0, c1, c2;
};
template <class T>
DEFINITE_INLINE PlaneRows<T> PlaneRowsOf(const T& alpha, const T& beta, const T& gamma) {
  return {{T(1.0), T(0.0), T(0.0)}, {-alpha, T(1.0), T(0.0)}, {-beta, -gamma, T(1.0)}};
}

// A frame in the plane of e0 and e1, whose normal is `sign` times the plane's: both tangents free.
template <class Stencil, class T>
DEFINITE_INLINE void SetPlane(const Plane<T>& plane, const Edges<T>& edges, const T& sign,
                              CollisionFrame<T, Stencil, 2>& f) {
  const PlaneRows<T> rows = PlaneRowsOf(plane.alpha, plane.beta, plane.gamma);
  f.n = sign * plane.normal;
  f.l = Dot(f.n, edges.e2);
  f.w = rows.c2;
  f.t[0] = plane.t0;
  f.t[1] = plane.t1;
  f.rows[0] = rows.c0;
  f.rows[1] = rows.c1;
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
template <Part kPart, Tangents kTangents, class T, class Stencil, int kSlots>
DEFINITE_INLINE auto PairModes(const CollisionFrame<T, Stencil, kSlots>& f, const T& psi1,
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

// In x: q -> S^T q, block j is sigma S_ij n + w_j t. kTriangular: the first row is that of the
// first edge, as the paper's frame has it.
template <bool kTriangular, class T, class Stencil, int kSlots, int K, bool kTurning>
DEFINITE_INLINE auto PullBack(const CollisionFrame<T, Stencil, kSlots>& f,
                              const FrameModes<T, K, kTurning>& frame_modes) {
  FramedModes<T, Stencil, K, kTurning> modes;
  modes.w = f.w;
  modes.n = f.n;
#pragma GCC unroll 8
  for (int m = 0; m < K; ++m) {
    const FrameMode<T>& q = frame_modes.mode[m];
    modes.lambda[m] = q.lambda;
    modes.t[m] = q.tangent;
    modes.turns[m] = q.slot >= 0 && kTriangular ? q.slot + 1
                     : q.slot >= 0              ? Stencil::kEdges - 1
                                                : 0;
    if (q.slot >= 0) modes.r[m] = q.sigma * f.rows[q.slot];
  }
  return modes;
}

// A Hessian in the frame coordinates c with the map S to them (Eq. 19): modes as stacked vectors.
template <class T, class Stencil, int kSlots, int K, bool kTurning>
auto ToFrameTerm(const CollisionFrame<T, Stencil, kSlots>& f,
                 const FrameModes<T, K, kTurning>& frame_modes) {
  FrameTerm<T, 3 * (kSlots + 1), Stencil::kDofs, K> term;
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
    const auto row = OverVertices<Stencil>(slot < kSlots ? f.rows[slot] : f.w);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < Stencil::kDofs; ++j) {
        term.map[3 * slot + i][j] = j % 3 == i ? row[j / 3] : T(0.0);
      }
    }
  }
  return term;
}

// The free tangents of a frame and their rows over lengths, rows[i] / len_i, turned so that the
// rows are orthogonal: sum_i rows[i] t[i]^T / len_i = sum_k sigma[k] v[k] t[k]^T, the singular
// value decomposition. sigma descends.
template <class T, class Stencil, int kSlots>
struct TurnedRows {
  Vec<T, Stencil::kEdges> v[kSlots];  // over the vertices unit rows; zero where fixed
  T sigma[kSlots];
  Vec3<T> t[kSlots];
};

// Source: docs/derivations.md, section 1.
template <Tangents kTangents, class T, class Stencil, int kSlots>
requires(kSlots > 0) DEFINITE_INLINE TurnedRows<T, Stencil, kSlots> TurnedRowsOf(
    const CollisionFrame<T, Stencil, kSlots>& f) {
  using Row = Vec<T, Stencil::kEdges>;
  using internal::Shared;
  constexpr double kNegligible = 1e-140;  // beside 1/16, the least of what is not zero
  TurnedRows<T, Stencil, kSlots> turned;
  if constexpr (kSlots == 1) {
    const T length = ConstantRoot<T>::Of(Shared<Stencil>(0, 0));
    turned.v[0] = {T(1.0) / length, T(0.0)};
    turned.sigma[0] = f.inverse_length[0] * length;
    turned.t[0] = f.t[0];
  } else {
    constexpr bool kByRegion = kTangents.of[0] == Tangent::kByRegion;
    T inverse[2] = {f.inverse_length[0], f.inverse_length[1]};
    const Row &row0 = f.rows[0], &row1 = f.rows[1];
    T product00, product01, product11;  // of the rows
    if constexpr (kByRegion) {
      for (int i = 0; i < 2; ++i) inverse[i] = Select(f.fixed[i], T(0.0), inverse[i]);
      product00 = InnerProduct<Stencil>(row0, row0);
      product01 = InnerProduct<Stencil>(row0, row1);
      product11 = InnerProduct<Stencil>(row1, row1);
    } else {
      // Row 0 is the first edge, and row 1 the second less a part of the first.
      const Row with1 = WithEdges<Stencil>(row1);
      product00 = T(static_cast<double>(Shared<Stencil>(0, 0)));
      product01 = with1[0];
      product11 = MulAdd(row1[0], with1[0], with1[1]);
    }
    const T m00 = product00 * (inverse[0] * inverse[0]);
    const T m01 = product01 * (inverse[0] * inverse[1]);
    const T m11 = product11 * (inverse[1] * inverse[1]);
    const T half = T(0.5) * (m00 - m11);
    const T root = Sqrt(MulAdd(half, half, m01 * m01));
    const T larger2 = MulAdd(T(0.5), m00 + m11, root);
    turned.sigma[0] = Sqrt(Max(larger2, T(kNegligible)));
    const T inverse_larger = T(1.0) / turned.sigma[0];
    // The smaller from the determinant, without cancellation; zero if one is fixed.
    const T area = ConstantRoot<T>::Of(internal::GramDeterminant<Stencil>(2)),
            inverse_area = T(1.0) / area;
    turned.sigma[1] = (area * (inverse[0] * inverse[1])) * inverse_larger;
    // (c, s) belongs to the larger one; both are as large if `along` is nothing.
    const T along = Max(Abs(half) + root, T(kNegligible));
    const T norm = T(1.0) / Sqrt(MulAdd(along, along, m01 * m01));
    const T cosine = along * norm, sine = m01 * norm;
    const auto swapped = half < T(0.0);
    const T c = Select(swapped, sine, cosine), s = Select(swapped, cosine, sine);
    turned.t[0] = c * f.t[0] + s * f.t[1];
    turned.t[1] = c * f.t[1] - s * f.t[0];
    const T of0 = inverse_larger * (c * inverse[0]), of1 = inverse_larger * (s * inverse[1]);
    if constexpr (kByRegion) {
      turned.v[0] = of0 * row0 + of1 * row1;
    } else {
      turned.v[0] = {MulAdd(of1, row1[0], of0), of1, T(0.0)};
    }
    // Normal to it, in the plane of the two edges.
    const Row with = WithEdges<Stencil>(turned.v[0]);
    turned.v[1] = {-(inverse_area * with[1]), inverse_area * with[0], T(0.0)};
    if constexpr (kByRegion) {
      for (int e = 0; e < 2; ++e) turned.v[1][e] = Select(f.fixed[1], T(0.0), turned.v[1][e]);
    }
  }
  return turned;
}

// The same geometric term in orthogonal vectors of x: as a frame whose rows are as long as w.
template <Tangents kTangents, class T, class Stencil, int kSlots>
DEFINITE_INLINE void TurnInX(CollisionFrame<T, Stencil, kSlots>& f) {
  if constexpr (kTangents.of[0] != Tangent::kFixed) {
    const auto turned = TurnedRowsOf<kTangents>(f);
    const auto w = OverVertices<Stencil>(f.w);
    const T width2 = Dot(w, w), inverse_width = T(1.0) / Sqrt(width2);
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      f.rows[k] = (width2 * inverse_width) * turned.v[k];
      f.inverse_length[k] = turned.sigma[k] * inverse_width;
      f.t[k] = turned.t[k];
    }
  }
}

}  // namespace definite
