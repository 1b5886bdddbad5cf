#pragma once

// The distance u of a vertex to the line of an edge, with a sign of its own: l = s u.
//
// Source: docs/derivations.md, section 3. The closest point slides along the edge, so that tangent
// is free; across the edge nothing follows, that one is fixed.
// Domain: the edge above kLeastEdge, and u above kLeastLength.

#include "kernels/lengths/signed.hpp"
#include "kernels/stencils/vertex_edge.hpp"

namespace definite {

struct UnsignedLine {
  using Stencil = VertexEdge;
  static constexpr std::string_view kName = "unsigned";
  static constexpr std::string_view kSource = "vertex-edge: docs/derivations.md, section 3";
  static constexpr std::string_view kSide = "-1 penetrating, +1 and 0 outside";
  static constexpr Tangents kTangents = kFreeAndFixed;

  template <class T>
  static DEFINITE_INLINE CollisionFrame<T, Stencil, 1> FrameOf(const Vec<T, 9>& x, const T& side) {
    CollisionFrame<T, Stencil, 1> f;
    const Vec3<T> x1 = Vertex(x, 1);
    Vec3<T> d = Vertex(x, 0) - x1, e = Vertex(x, 2) - x1;
    Prescale(f, d, e);
    T a2 = Dot(e, e);
    const auto no_edge = a2 <= T(kLeastEdge * kLeastEdge);
    a2 = Select(no_edge, T(1.0), a2);
    f.inverse_length[0] = T(1.0) / Sqrt(a2);
    const Vec3<T> t = f.inverse_length[0] * e;
    const T beta = Dot(t, d) * f.inverse_length[0];
    // t x d, not d - beta e: that would lose its right angle to the edge.
    const Vec3<T> across = Cross(t, d);
    T u2 = Dot(across, across);
    const auto touching = u2 <= T(kLeastLength * kLeastLength);
    u2 = Select(touching, T(1.0), u2);
    const T u = Sqrt(u2);
    const T sign = Orientation(side);
    f.outside = no_edge | touching;
    f.l = sign * u;
    f.t[0] = t;
    f.t[1] = (sign / u) * across;
    f.n = Cross(f.t[1], t);
    f.w = {-beta, T(1.0)};
    f.rows[0] = {T(1.0), T(0.0)};
    f.region = T(0.0);
    return f;
  }
};

}  // namespace definite
