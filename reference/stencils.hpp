#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/dual.hpp"
#include "reference/vec3.hpp"

namespace definite::reference {

// The three edges that a collision length is made of (Shi & Kim 2023, section 3.1).
template <class S>
struct Edges {
  Vec3<S> e0, e1, e2;
};

// x = the vertex x0, then the triangle x1, x2, x3. Orientation trap: e0 x e1 is opposite to the
// usual normal of the counterclockwise triangle (x1, x2, x3).
struct VertexFace {
  static std::string Name() { return "collision/vertex_face"; }
  static constexpr int kDofs = 12;

  template <class S>
  static Edges<S> EdgesOf(const S* x) {
    const Vec3<S> x0 = Block(x, 0), x1 = Block(x, 1), x2 = Block(x, 2), x3 = Block(x, 3);
    return {x1 - x2, x3 - x2, x0 - x2};
  }
};

// Edge A = x0, x1; edge B = x2, x3. The sign of the triple product of the edges is an orientation:
// reversing one edge turns it around.
struct EdgeEdge {
  static std::string Name() { return "collision/edge_edge"; }
  static constexpr int kDofs = 12;

  template <class S>
  static Edges<S> EdgesOf(const S* x) {
    const Vec3<S> x0 = Block(x, 0), x1 = Block(x, 1), x2 = Block(x, 2), x3 = Block(x, 3);
    return {x1 - x0, x3 - x2, x2 - x0};
  }
};

// The vertex x0 and the edge x1, x2: e0 is the edge, e2 = x0 - x1; there is no e1.
struct VertexEdge {
  static std::string Name() { return "collision/vertex_edge"; }
  static constexpr int kDofs = 9;

  template <class S>
  static Edges<S> EdgesOf(const S* x) {
    const Vec3<S> x0 = Block(x, 0), x1 = Block(x, 1), x2 = Block(x, 2);
    return {x2 - x1, {}, x0 - x1};
  }
};

// Two vertices: e2 = x1 - x0; there is no e0, no e1.
struct VertexVertex {
  static std::string Name() { return "collision/vertex_vertex"; }
  static constexpr int kDofs = 6;

  template <class S>
  static Edges<S> EdgesOf(const S* x) {
    return {{}, {}, Block(x, 1) - Block(x, 0)};
  }
};

// The edges of x, its values alone.
template <class Stencil, class S>
auto PlainEdgesOf(const S* x) {
  const auto values = Values<Stencil::kDofs>(x);
  return Stencil::EdgesOf(values.data());
}

// The edges that are stacked in a frame c of 9 numbers, and back.
template <class S>
Edges<S> FrameEdges(const S* c) {
  return {Block(c, 0), Block(c, 1), Block(c, 2)};
}
template <class S>
std::array<S, 9> Stack(const Edges<S>& e) {
  return {e.e0.x, e.e0.y, e.e0.z, e.e1.x, e.e1.y, e.e1.z, e.e2.x, e.e2.y, e.e2.z};
}

// The sine of the angle between e0 and e1 must exceed 1e-8 (tau of docs/protocol.md, section 1).
// False for a zero or non-finite edge.
template <class S>
bool SpanPlane(const Edges<S>& e) {
  return Norm(Cross(e.e0, e.e1)) > S(1e-8) * Norm(e.e0) * Norm(e.e1);
}

// The sine of the angle between e0 and e1.
template <class S>
double SineOfEdges(const Edges<S>& e) {
  return static_cast<double>(Norm(Cross(e.e0, e.e1)) / Norm(e.e0) / Norm(e.e1));
}

// How large a length d is against the edges: min(1, d / the longest). Rounding moves points by a
// part of the longest edge, so it turns the vector between two points at distance d, and changes a
// psi'' with the margin d, by that part over this number.
template <class S>
double Nearness(const S& d, const Edges<S>& e) {
  const S longest = std::max({Norm(e.e0), Norm(e.e1), Norm(e.e2)});
  return std::min(1.0, static_cast<double>(d / longest));
}

// n.e2 (Eq. 1): how far e2 reaches along the normal of e0 and e1.
template <class S>
S AlongNormal(const Edges<S>& e) {
  const Vec3<S> normal = Cross(e.e0, e.e1);
  return Dot(normal, e.e2) / Norm(normal);
}

// The same to a line along e.
template <class S>
S DistanceToLine(const Vec3<S>& v, const Vec3<S>& e) {
  return Norm(v - Dot(v, e) / Dot(e, e) * e);
}

// |v| to first order: how far v reaches along the direction that its value has.
template <class S>
S LinearNorm(const Vec3<S>& v) {
  const Vec3<S> value{S(ValueOf(v.x)), S(ValueOf(v.y)), S(ValueOf(v.z))};
  return Dot(value, v) / Norm(value);
}

// A length turned around by a negative side.
template <class S, class T>
S OnSide(const S& l, const T& side) {
  return side < 0 ? -l : l;
}

// The sign of n.e2, turned around by a negative side. 0 counts as positive, as do edges that span
// no plane.
template <class T>
int Orientation(const Edges<T>& e, const T& side) {
  const T triple = Dot(Cross(e.e0, e.e1), e.e2);
  const bool negative = side < 0 ? triple > 0 : triple < 0;
  return SpanPlane(e) && negative ? -1 : 1;
}

// The sign of an unsigned length: the side that is given, or, for 0, the one that e2 is on.
template <class T>
int GivenSide(const Edges<T>& e, const T& side) {
  return side < 0 ? -1 : side > 0 ? 1 : Orientation(e, side);
}

// e2 - be e0 - ga e1 is normal to e0 and e1, and e1 - al e0 to e0.
template <class S>
struct Weights {
  S al, be, ga;
};

template <class S>
Weights<S> GramSchmidt(const Edges<S>& e) {
  const S al = Dot(e.e1, e.e0) / Dot(e.e0, e.e0);
  const Vec3<S> e1_perp = e.e1 - al * e.e0;
  const S ga = Dot(e.e2, e1_perp) / Dot(e1_perp, e1_perp);
  const S be = Dot(e.e2 - ga * e.e1, e.e0) / Dot(e.e0, e.e0);
  return {al, be, ga};
}

// The reduced frame c = (e0 | e1 - al e0 | e2 - be e0 - ga e1) of x, Eq. 2, with the Gram-Schmidt
// weights frozen at `at`; stacked, 9 numbers. With at = x, both dual, the weights follow x.
template <class Stencil, class S, class T>
std::array<S, 9> FrozenFrame(const S* x, const T* at) {
  const auto [al, be, ga] = GramSchmidt(Stencil::EdgesOf(at));
  const auto [e0, e1, e2] = Stencil::EdgesOf(x);
  return Stack(Edges<S>{e0, e1 - al * e0, e2 - be * e0 - ga * e1});
}

}  // namespace definite::reference
