#pragma once

// Lengths between two edges whose closest points are clamped to both.
//
// Source: Shi & Kim 2023, Eqs. 25, 36-48, 53, and Cheng's hybrid as their section 5.2.1 and Table 1
// use it.
// Differs: the two parameters are clamped jointly (one by one would be wrong for half of all random
// pairs); Eq. 25 with the right activation test; in the interior the normal comes from the cross
// product, never from a difference of close points.
// Domain: both edges above kLeastEdge, and the distance above kLeastLength. Parallel edges are
// in it: their closest points are taken at an endpoint.

#include <limits>

#include "kernels/lengths/unsigned_plane.hpp"
#include "kernels/stencils/edge_edge.hpp"

namespace definite {

// Which Hessian a pair has when a closest point is an endpoint, and inside.
enum class Clamped {
  kEnvelope,  // inside free, at an endpoint as the distance to a vertex: the exact Hessian
  kFrozen,    // parameters held constant everywhere, Eq. 53
  kHybrid,    // inside signed, at an endpoint frozen
};

// The regions that Classify tells apart.
inline constexpr double kInterior = 0, kVertexEdge = 1, kVertexVertex = 2;

template <Clamped kKind>
struct ClosestEdges {
  using Stencil = EdgeEdge;
  static constexpr std::string_view kName = kKind == Clamped::kEnvelope ? "unsigned"
                                            : kKind == Clamped::kFrozen ? "unsigned_frozen"
                                                                        : "hybrid";
  static constexpr std::string_view kSource =
      kKind == Clamped::kEnvelope ? "Shi & Kim 2023, Eqs. 16, 25, 36-40; envelope theorem"
      : kKind == Clamped::kFrozen ? "Shi & Kim 2023, Eqs. 25, 36-48, 53"
                                  : "Shi & Kim 2023, section 5.2.1 after Cheng et al. 2022";
  static constexpr std::string_view kSide =
      kKind == Clamped::kHybrid ? "sign of the triple product: -1 flips it, +1 and 0 keep it"
                                : "+1 outside, -1 penetrating, 0 by the sign of the triple product";
  static constexpr Tangents kTangents = kKind == Clamped::kFrozen ? kBothFixed : kBothByRegion;

  template <class T>
  static DEFINITE_INLINE CollisionFrame<T, Stencil, 2> FrameOf(const Vec<T, 12>& x, const T& side) {
    CollisionFrame<T, Stencil, 2> f;
    Edges<T> edges = Stencil::EdgesOf(x);
    Prescale(f, edges);
    const Plane<T> plane = PlaneOf(edges);
    const T triple = Select(plane.parallel, T(0.0), Dot(plane.normal, edges.e2));
    const T sign = Select(triple < T(0.0), T(-1.0), T(1.0));
    const T s = kKind == Clamped::kHybrid
                    ? Select(Orientation(side) * triple < T(0.0), T(-1.0), T(1.0))
                    : SideOrSignOf(side, triple);
    // Inside, the length is s |triple|; for the hybrid that is the signed length, whose normal does
    // not hang on the sign of a triple product of 0.
    SetPlane<Stencil>(plane, edges, kKind == Clamped::kHybrid ? Orientation(side) : s * sign, f);
    const auto endpoint = plane.parallel | (plane.beta <= T(0.0)) | (plane.beta >= T(1.0)) |
                          (plane.gamma >= T(0.0)) | (plane.gamma <= T(-1.0));
    SetEndpoint(edges, s, endpoint, f);
    return f;
  }

 private:
  // A vertex of one edge and the point nearest to it on the other, as a candidate.
  template <class T>
  struct Candidate {
    T a, b;           // parameters of the closest points
    Vec3<T> between;  // from edge A to edge B
    T squared;
    T free;  // 1 if the point on the other edge is inside it
    T back;  // how much nearer the own edge would come, beyond its vertex: 0 if not at all
  };

  // Vertex at parameter a of A, `from` it to the start of B.
  template <class T>
  static DEFINITE_INLINE Candidate<T> AgainstB(const Edges<T>& e, const Vec3<T>& from, bool at_end,
                                               const T& inverse_a, const T& inverse_b) {
    const T b = -(Dot(from, e.e1) * inverse_b * inverse_b);
    Candidate<T> c = Clamp(b, T(at_end ? 1.0 : 0.0));
    SetBetween(from, inverse_b * e.e1, c.b * e.e1, c);
    SetBack(Dot(c.between, inverse_a * e.e0), at_end, c);
    return c;
  }
  // Vertex at parameter b of B, `from` the start of A to it.
  template <class T>
  static DEFINITE_INLINE Candidate<T> AgainstA(const Edges<T>& e, const Vec3<T>& from, bool at_end,
                                               const T& inverse_a, const T& inverse_b) {
    const T a = Dot(from, e.e0) * inverse_a * inverse_a;
    Candidate<T> c = Clamp(a, T(at_end ? 1.0 : 0.0));
    std::swap(c.a, c.b);
    SetBetween(from, inverse_a * e.e0, -c.a * e.e0, c);
    SetBack(-Dot(c.between, inverse_b * e.e1), at_end, c);
    return c;
  }
  // The parameter clamped to [0, 1], in b, and the vertex's own in a.
  template <class T>
  static DEFINITE_INLINE Candidate<T> Clamp(const T& parameter, const T& own) {
    Candidate<T> c;
    c.a = own;
    const auto below = parameter <= T(0.0), above = parameter >= T(1.0);
    c.b = Select(below, T(0.0), Select(above, T(1.0), parameter));
    c.free = Select(below | above, T(0.0), T(1.0));
    return c;
  }
  // To a point inside the edge along t the way is across it: t x from x t keeps the right angle,
  // from + step, a difference of near ones, would lose it.
  template <class T>
  static DEFINITE_INLINE void SetBetween(const Vec3<T>& from, const Vec3<T>& t, const Vec3<T>& step,
                                         Candidate<T>& c) {
    c.between = SelectAll(c.free > T(0.0), Cross(Cross(t, from), t), from + step);
    c.squared = Dot(c.between, c.between);
  }
  // Along the own edge the distance falls by `falls`: there is nothing beyond its vertex.
  template <class T>
  static DEFINITE_INLINE void SetBack(const T& falls, bool at_end, Candidate<T>& c) {
    c.back = Max(at_end ? -falls : falls, T(0.0));
  }

  // Replaces the frame, where `endpoint`, by that of the nearest vertex.
  template <class T>
  static DEFINITE_INLINE void SetEndpoint(const Edges<T>& edges, const T& s,
                                          const MaskOf<T>& endpoint,
                                          CollisionFrame<T, Stencil, 2>& f) {
    const auto& [e0, e1, e2] = edges;
    T aa = Dot(e0, e0), bb = Dot(e1, e1);
    const auto no_edge = (aa <= T(kLeastEdge * kLeastEdge)) | (bb <= T(kLeastEdge * kLeastEdge));
    aa = Select(no_edge, T(1.0), aa);
    bb = Select(no_edge, T(1.0), bb);
    const T inverse_a = T(1.0) / Sqrt(aa), inverse_b = T(1.0) / Sqrt(bb);
    const Candidate<T> candidates[4] = {AgainstB(edges, e2, false, inverse_a, inverse_b),
                                        AgainstB(edges, e2 - e0, true, inverse_a, inverse_b),
                                        AgainstA(edges, e2, false, inverse_a, inverse_b),
                                        AgainstA(edges, e2 + e1, true, inverse_a, inverse_b)};
    Candidate<T> best = candidates[0];
    T on_a = T(0.0);  // 1 if the free edge is A
#pragma GCC unroll 3
    for (int i = 1; i < 4; ++i) {
      // Distances differ in their last digits only where the edges are far apart; that the own edge
      // comes no nearer beyond its vertex tells the nearest candidate from the others in their
      // first. Of several, parallel edges have them, the nearest.
      const Candidate<T>& c = candidates[i];
      const T squared =
          Select(c.back > best.back, T(std::numeric_limits<double>::infinity()), c.squared);
      const auto nearer = (c.back < best.back) | (squared < best.squared);
      best.a = Select(nearer, c.a, best.a);
      best.b = Select(nearer, c.b, best.b);
      best.squared = Select(nearer, c.squared, best.squared);
      best.free = Select(nearer, c.free, best.free);
      best.back = Select(nearer, c.back, best.back);
      on_a = Select(nearer, T(i < 2 ? 0.0 : 1.0), on_a);
      best.between = SelectAll(nearer, c.between, best.between);
    }
    const auto touching = best.squared <= T(kLeastLength * kLeastLength);
    f.outside = no_edge | touching;
    const T u = Sqrt(Select(f.outside, T(1.0), best.squared));
    const Vec3<T> n = (s / u) * best.between;

    const auto is_free = best.free > T(0.0), along_a = on_a > T(0.0);
    // Along the free edge, else along any axis; made normal to n.
    const Vec3<T> t = SelectAll(along_a, inverse_a * e0, inverse_b * e1);
    Vec3<T> d = SelectAll(is_free, t, AxisOff(n));
    d = d - Dot(d, n) * n;
    const T squared_d = Dot(d, d);
    const Vec3<T> t0 = (T(1.0) / Sqrt(Select(f.outside, T(1.0), squared_d))) * d;
    const Vec3<T> t1 = Cross(n, t0);
    const Vec3<T> row = {Select(along_a, T(1.0), T(0.0)), Select(along_a, T(0.0), T(1.0)), T(0.0)};
    const Vec3<T> w = {-best.a, best.b, T(1.0)};

    f.l = Select(endpoint, s * u, f.l);
    f.n = SelectAll(endpoint, n, f.n);
    f.w = SelectAll(endpoint, w, f.w);
    f.t[0] = SelectAll(endpoint, t0, f.t[0]);
    f.t[1] = SelectAll(endpoint, t1, f.t[1]);
    f.region = Select(endpoint, Select(is_free, T(kVertexEdge), T(kVertexVertex)), T(kInterior));
    if constexpr (kKind != Clamped::kHybrid) {
      const auto touching_inside = Abs(f.l) <= T(kLeastLength);
      f.outside = f.outside | touching_inside;
      f.l = Select(touching_inside, T(1.0), f.l);
    }
    if constexpr (kKind != Clamped::kFrozen) {
      f.rows[0] = SelectAll(endpoint, row, f.rows[0]);
      f.inverse_length[0] =
          Select(endpoint, Select(along_a, inverse_a, inverse_b), f.inverse_length[0]);
      f.fixed[1] = endpoint;
      if constexpr (kKind == Clamped::kHybrid) {
        f.fixed[0] = endpoint;
      } else {
        f.fixed[0] = Select(endpoint, Select(is_free, T(0.0), T(1.0)), T(0.0)) > T(0.0);
      }
    }
  }
};

}  // namespace definite
