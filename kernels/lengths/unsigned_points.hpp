#pragma once

// The distance u of two vertices, with a sign of its own: l = s u. Both tangents are fixed.
//
// Source: docs/derivations.md, section 3.
// Domain: u above kLeastLength of the largest component, that is, u > 0.

#include "kernels/lengths/signed.hpp"
#include "kernels/stencils/vertex_vertex.hpp"

namespace definite {

struct UnsignedPoints {
  using Stencil = VertexVertex;
  static constexpr std::string_view kName = "unsigned";
  static constexpr std::string_view kSource = "vertex-vertex: docs/derivations.md, section 3";
  static constexpr std::string_view kSide = "-1 penetrating, +1 and 0 outside";
  static constexpr Tangents kTangents = kBothFixed;

  template <class T>
  static DEFINITE_INLINE CollisionFrame<T, Stencil, 0> FrameOf(const Vec<T, 6>& x, const T& side) {
    CollisionFrame<T, Stencil, 0> f;
    Vec3<T> d = Vertex(x, 1) - Vertex(x, 0);
    Prescale(f, d);
    T u2 = Dot(d, d);
    f.outside = u2 <= T(kLeastLength * kLeastLength);
    u2 = Select(f.outside, T(1.0), u2);
    const T u = Sqrt(u2), sign = Orientation(side);
    f.l = sign * u;
    f.n = (sign / u) * d;
    const Vec3<T> axis = AxisOff(f.n);
    const Vec3<T> t = axis - Dot(axis, f.n) * f.n;
    f.t[0] = (T(1.0) / Sqrt(Dot(t, t))) * t;
    f.t[1] = Cross(f.n, f.t[0]);
    f.w = {T(1.0)};
    f.region = T(0.0);
    return f;
  }
};

}  // namespace definite
