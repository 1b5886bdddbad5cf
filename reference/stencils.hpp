#pragma once

#include <array>
#include <string_view>

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
  static constexpr std::string_view kName = "collision/vertex_face";
  static constexpr int kDofs = 12;

  template <class S>
  static Edges<S> EdgesOf(const S* x) {
    const Vec3<S> x0 = Block(x, 0), x1 = Block(x, 1), x2 = Block(x, 2), x3 = Block(x, 3);
    return {x1 - x2, x3 - x2, x0 - x2};
  }
};

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

// The reduced frame c = (e0 | e1 - al e0 | e2 - be e0 - ga e1) of x, Eq. 2, with the Gram-Schmidt
// weights frozen at `at`; stacked, 9 numbers.
template <class Stencil, class S, class T>
std::array<S, 9> FrozenFrame(const S* x, const T* at) {
  const Edges<T> e = Stencil::EdgesOf(at);
  const T al = Dot(e.e1, e.e0) / Dot(e.e0, e.e0);
  const Vec3<T> e1_perp = e.e1 - al * e.e0;
  const T ga = Dot(e.e2, e1_perp) / Dot(e1_perp, e1_perp);
  const T be = Dot(e.e2 - ga * e.e1, e.e0) / Dot(e.e0, e.e0);

  const auto [e0, e1, e2] = Stencil::EdgesOf(x);
  const Vec3<S> c1 = e1 - al * e0;
  const Vec3<S> c2 = e2 - be * e0 - ga * e1;
  return {e0.x, e0.y, e0.z, c1.x, c1.y, c1.z, c2.x, c2.y, c2.z};
}

}  // namespace definite::reference
