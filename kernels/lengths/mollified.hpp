#pragma once

// m(c) psi(l), l the distance of two edges and c = |N|^2, N = e0 x e1: the reduced frame and the
// modes of its Hessian, whichever the closest points are.
//
// Source: docs/derivations.md, section 4; m after Li et al. 2020.
// The frame. c does not change when a multiple of one edge is added to the other, nor l when a
// multiple of an edge along which the closest point slides is added to the vector between the
// points. So the coordinates c0 (an edge: the one with a closest point inside it, e0 if both or
// none), c1 (the other one, less alpha c0) and c2 (between the closest points) lose nothing by
// weights that are frozen, and in them c0, c1 and c2 are normal to each other as far as it matters.
// Shapes and units: as in collision_frame.hpp. Nothing is divided by c or by |c1|, so that nothing
// grows where the edges turn parallel.

#include "kernels/core/jacobi.hpp"
#include "kernels/lengths/closest_edges.hpp"

namespace definite {

// c0 = a t0, c1 = b t1, c2 = l n, unit vectors. b may be negative: t0 x t1 = normal.
template <class T>
struct MollifiedFrame {
  CollisionFrame<T, EdgeEdge, 2> length;
  Vec3<T> row0, row1;  // of c0 and c1 over the edges; that of c2 is length.w
  T a, b, inverse_a, alpha;
  Vec3<T> t0, t1, normal;
  // normal = cosine along + sine across, t1 = sine along - cosine across; `along` is n where the
  // closest points make n normal to c0.
  Vec3<T> along, across;
  T cosine, sine;
  T c;
  Vec3<T> slope0, slope1;  // e1 x N and N x e0: half the gradients of c along e0 and e1
};

// The direction of c1, and its length, where that may be a rounding error of `second`.
template <class T>
struct Direction {
  Vec3<T> unit;
  T length;
};
template <class T>
DEFINITE_INLINE Direction<T> PartNormalTo(const Vec3<T>& t0, const Vec3<T>& second) {
  // Twice, for what the first time leaves along t0 is as large as what is left of parallel edges.
  Vec3<T> v = second - Dot(t0, second) * t0;
  v = v - Dot(t0, v) * t0;
  const T squared = Dot(v, v);
  const auto none = squared <= T(0x1p-100) * Dot(second, second);
  const Vec3<T> axis = AxisOff(t0);
  const Vec3<T> d = SelectAll(none, axis - Dot(t0, axis) * t0, v);
  const T length = Sqrt(Dot(d, d));
  return {(T(1.0) / length) * d, Select(none, T(0.0), length)};
}

template <class T>
DEFINITE_INLINE MollifiedFrame<T> MollifiedFrameOf(const Vec<T, 12>& x, const T& side) {
  MollifiedFrame<T> frame;
  auto& f = frame.length;
  f = ClosestEdges<Clamped::kEnvelope>::FrameOf(x, side);
  auto [e0, e1, e2] = EdgeEdge::EdgesOf(x);
  e0 = f.scale * (f.lift * e0);
  e1 = f.scale * (f.lift * e1);
  const Vec3<T> cross = CarefulCross(e0, e1);
  frame.c = Dot(cross, cross);
  frame.slope0 = Cross(e1, cross);
  frame.slope1 = Cross(cross, e0);

  const auto at_end = f.fixed[1];  // not both points inside
  const auto is_vertices = f.fixed[0];
  const T along_b = Select(is_vertices, T(0.0), f.rows[0][1]);
  const auto swapped = along_b > T(0.0);
  const Vec3<T> first = SelectAll(swapped, e1, e0), second = SelectAll(swapped, e0, e1);
  const Vec3<T> of_a = {T(1.0), T(0.0), T(0.0)}, of_b = {T(0.0), T(1.0), T(0.0)};

  frame.a = Sqrt(Select(f.outside, T(1.0), Dot(first, first)));
  frame.inverse_a = T(1.0) / frame.a;
  frame.t0 = frame.inverse_a * first;
  frame.alpha = Dot(frame.t0, second) * frame.inverse_a;
  frame.row0 = SelectAll(swapped, of_b, of_a);
  frame.row1 = SelectAll(swapped, of_a, of_b) - frame.alpha * frame.row0;

  // Inside, n is the normal of both edges, and all directions are the length's.
  const Direction<T> apart = PartNormalTo(frame.t0, second);
  const T b = Sqrt(frame.c) * frame.inverse_a;
  const T b_inside = Select(Dot(f.n, cross) < T(0.0), -b, b);
  frame.t1 = SelectAll(at_end, apart.unit, Cross(f.n, frame.t0));
  frame.b = Select(at_end, apart.length, b_inside);
  frame.normal = SelectAll(at_end, Cross(frame.t0, frame.t1), f.n);
  // Between two vertices n is normal to neither edge; any pair of directions will do.
  const auto turns = [&](const T& sliding, const T& otherwise) {
    return Select(is_vertices, otherwise, Select(at_end, sliding, otherwise));
  };
  frame.cosine = turns(Dot(f.n, frame.normal), T(1.0));
  frame.sine = turns(Dot(f.n, frame.t1), T(0.0));
  frame.along = SelectAll(is_vertices, frame.normal, f.n);
  frame.across = Cross(frame.t0, frame.along);
  return frame;
}

// Of m psi: what its Hessian weighs its parts with. psi1 and psi2 as elsewhere; the mollifier's m
// is c/ex (2 - c/ex) below ex, m1 and m2 are its derivatives.
template <class T>
struct MollifiedWeights {
  T psi_m1, psi_cm2;   // psi m', psi c m''
  T psi1_m1;           // psi' m'
  T psi1_m, psi1_m_c;  // psi' m, psi' m / c
  T psi2_m;            // psi'' m
};

// A vector of the frame from its three parts.
template <class T>
DEFINITE_INLINE Vec<T, 9> InFrame(const Vec3<T>& in0, const Vec3<T>& in1, const Vec3<T>& in2) {
  return {in0[0], in0[1], in0[2], in1[0], in1[1], in1[2], in2[0], in2[1], in2[2]};
}

// The entries of the Hessian in the frame, on functionals of a change (d0, d1, d2).
template <class T>
struct MollifiedEntries {
  T turn[3];       // on (along.d0, t[0].d2): c0 turns, and the closest point with it
  T tilt[3];       // on (normal.d1, t[1].d2): c1 leaves the plane
  T lift;          // on normal.d0: c0 leaves the plane
  T shear;         // t0.d0 with t1.d1, and minus it t1.d0 with t0.d1
  T grow, couple;  // on b t0.d0 + a t1.d1, the growth of |N|; that with n.d2
  T curvature;     // on n.d2
};

template <class T>
DEFINITE_INLINE MollifiedEntries<T> EntriesOf(const MollifiedFrame<T>& frame,
                                              const MollifiedWeights<T>& weights) {
  const auto& f = frame.length;
  const T& a = frame.a;
  const T& b = frame.b;
  const T zero = T(0.0);
  MollifiedEntries<T> h;
  // The pairs of collision_frame.hpp, and psi'/l on a tangent that is fixed.
  const T fixed = weights.psi1_m / f.l;
  const T turn = weights.psi1_m * frame.inverse_a;
  h.turn[0] = Select(f.fixed[0], zero, -(turn * f.l * frame.inverse_a));
  h.turn[1] = Select(f.fixed[0], zero, -turn);
  h.turn[2] = Select(f.fixed[0], fixed, zero);
  const T tilt = weights.psi1_m_c * (a * a);  // m / b^2 = (m / c) a^2
  const T twice = weights.psi_m1 + weights.psi_m1;
  h.tilt[0] = MulAdd(twice, a * a, Select(f.fixed[1], zero, -(tilt * f.l)));
  h.tilt[1] = Select(f.fixed[1], zero, -(tilt * Abs(b)));
  h.tilt[2] = Select(f.fixed[1], fixed, zero);
  h.lift = twice * (b * b);
  h.shear = twice * (a * b);
  h.grow = MulAdd(T(4.0), weights.psi_cm2, twice);
  h.couple = (weights.psi1_m1 + weights.psi1_m1) * (a * b);
  h.curvature = weights.psi2_m;
  return h;
}

// Both eigenvectors of [[h0, h1], [h1, h2]] on u and v, as the modes from `at` on.
template <class T, int K>
DEFINITE_INLINE void SetPair(const T (&h)[3], const Vec<T, 9>& u, const Vec<T, 9>& v, int at,
                             Modes<T, 9, K>& modes) {
  const Eigen2<T> e = SymmetricEigen2(h[0], h[1], h[2]);
  modes.lambda[at] = e.first;
  modes.v[at] = e.c * u + e.s * v;
  modes.lambda[at + 1] = e.second;
  modes.v[at + 1] = e.c * v - e.s * u;
}

// Modes in the frame whose sum does not cancel; no eigenvectors of it.
template <class T>
DEFINITE_INLINE Modes<T, 9, 11> SumOfModes(const MollifiedFrame<T>& frame,
                                           const MollifiedEntries<T>& h) {
  const auto& f = frame.length;
  const Vec3<T> none = {T(0.0), T(0.0), T(0.0)};
  Modes<T, 9, 11> modes;
  SetPair(h.turn, InFrame(frame.along, none, none), InFrame(none, none, f.t[0]), 0, modes);
  SetPair(h.tilt, InFrame(none, frame.normal, none), InFrame(none, none, f.t[1]), 2, modes);
  modes.lambda[4] = h.lift;
  modes.v[4] = InFrame(frame.normal, none, none);
  // u v^T + v u^T = ((u + v)(u + v)^T - (u - v)(u - v)^T) / 2, where u u^T and v v^T cancel: both
  // must be of one size, though the rows of d1 are as large as one edge is in units of the other.
  const T half = T(0.5) * h.shear;
  const T large = Sqrt(T(1.0) + Abs(frame.alpha)), small = T(1.0) / large;
  const auto pair = [&](const Vec3<T>& in0, const Vec3<T>& in1, double sign) {
    return InFrame(large * in0, T(sign) * (small * in1), none);
  };
  modes.lambda[5] = half;
  modes.v[5] = pair(frame.t0, frame.t1, 1);
  modes.lambda[6] = -half;
  modes.v[6] = pair(frame.t0, frame.t1, -1);
  modes.lambda[7] = -half;
  modes.v[7] = pair(frame.t1, frame.t0, 1);
  modes.lambda[8] = half;
  modes.v[8] = pair(frame.t1, frame.t0, -1);
  const T norm2 = MulAdd(frame.a, frame.a, frame.b * frame.b), norm = Sqrt(norm2);
  const T inverse = T(1.0) / norm;
  const T grow[3] = {h.grow * norm2, h.couple * norm, h.curvature};
  SetPair(grow, InFrame((inverse * frame.b) * frame.t0, (inverse * frame.a) * frame.t1, none),
          InFrame(none, none, f.n), 9, modes);
  return modes;
}

// The eigenvectors in the frame: blocks of four, two and three.
template <class T>
DEFINITE_INLINE Modes<T, 9, 9> EigenModes(const MollifiedFrame<T>& frame,
                                          const MollifiedEntries<T>& h) {
  const auto& f = frame.length;
  const T& a = frame.a;
  const T& b = frame.b;
  const T zero = T(0.0);
  const Vec3<T> none = {zero, zero, zero};
  Modes<T, 9, 9> modes;
  // On along.d0, across.d0, t0.d1, t[0].d2. Inside and between vertices the sine is 0, and the
  // block falls into two pairs, which one rotation each solves.
  const T lifted = h.lift * frame.cosine;
  T turning[4][4];
  turning[0][0] = MulAdd(lifted, frame.cosine, h.turn[0]);
  turning[0][1] = lifted * frame.sine;
  turning[0][2] = -(h.shear * frame.sine);
  turning[0][3] = h.turn[1];
  turning[1][1] = h.lift * frame.sine * frame.sine;
  turning[1][2] = h.shear * frame.cosine;
  turning[1][3] = zero;
  turning[2][2] = zero;
  turning[2][3] = zero;
  turning[3][3] = h.turn[2];
  const EigenSystem<T, 4> turned = JacobiEigen(turning);
  for (int m = 0; m < 4; ++m) {
    const auto& y = turned.vectors;
    modes.lambda[m] = turned.values[m];
    modes.v[m] = InFrame(y[0][m] * frame.along + y[1][m] * frame.across, y[2][m] * frame.t0,
                         y[3][m] * f.t[0]);
  }
  // On t0.d0, t1.d1, n.d2.
  T growing[3][3];
  growing[0][0] = h.grow * (b * b);
  growing[0][1] = MulAdd(h.grow, a * b, h.shear);
  growing[0][2] = h.couple * b;
  growing[1][1] = h.grow * (a * a);
  growing[1][2] = h.couple * a;
  growing[2][2] = h.curvature;
  const EigenSystem<T, 3> grown = JacobiEigen(growing);
  for (int m = 0; m < 3; ++m) {
    const auto& y = grown.vectors;
    modes.lambda[4 + m] = grown.values[m];
    modes.v[4 + m] = InFrame(y[0][m] * frame.t0, y[1][m] * frame.t1, y[2][m] * f.n);
  }
  SetPair(h.tilt, InFrame(none, frame.normal, none), InFrame(none, none, f.t[1]), 7, modes);
  return modes;
}

// q -> S^T q.
template <class T, int K>
DEFINITE_INLINE Modes<T, 12, K> PullBack(const MollifiedFrame<T>& frame,
                                         const Modes<T, 9, K>& modes) {
  const auto row0 = OverVertices<EdgeEdge>(frame.row0), row1 = OverVertices<EdgeEdge>(frame.row1);
  const auto row2 = OverVertices<EdgeEdge>(frame.length.w);
  Modes<T, 12, K> pulled;
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) {
    pulled.lambda[m] = modes.lambda[m];
    pulled.v[m] = AddKron(AddKron(Kron(row2, Vertex(modes.v[m], 2)), row1, Vertex(modes.v[m], 1)),
                          row0, Vertex(modes.v[m], 0));
  }
  return pulled;
}

}  // namespace definite
