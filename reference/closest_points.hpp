#pragma once

#include "reference/stencils.hpp"

namespace definite::reference {

// The closest points x0 + a e0 and x2 + b e1 of two edges, and which of them lie inside their edge,
// not at one of its ends.
template <class T>
struct ClosestPoints {
  T a, b;
  bool a_inside, b_inside;

  bool BothInside() const { return a_inside && b_inside; }
};

// From the first point to the second; a and b are constants.
template <class S, class T>
Vec3<S> Between(const Edges<S>& e, const ClosestPoints<T>& points) {
  return e.e2 - points.a * e.e0 + points.b * e.e1;
}

// By trying all: the feet of the common normal of both lines, every end against the other edge,
// every pair of ends. The nearest of those that lie on the edges; of equally near ones the first.
template <class T>
ClosestPoints<T> FindClosestPoints(const Edges<T>& e) {
  const auto inside = [](const T& t) { return 0 < t && t < 1; };
  // Nothing can be nearer than the feet of the common normal.
  const Weights<T> weights = GramSchmidt(e);
  if (SpanPlane(e) && inside(weights.be) && inside(-weights.ga))
    return {weights.be, -weights.ga, true, true};

  ClosestPoints<T> nearest{T(0), T(0), false, false};
  const auto offer = [&](const ClosestPoints<T>& points) {
    if (Norm(Between(e, points)) < Norm(Between(e, nearest))) nearest = points;
  };
  for (const T& end : {T(0), T(1)}) {
    const T a = Dot(e.e2 + end * e.e1, e.e0) / Dot(e.e0, e.e0);
    const T b = Dot(end * e.e0 - e.e2, e.e1) / Dot(e.e1, e.e1);
    if (inside(a)) offer({a, end, true, false});
    if (inside(b)) offer({end, b, false, true});
    for (const T& other_end : {T(0), T(1)}) offer({end, other_end, false, false});
  }
  return nearest;
}

// Both edges have a length. An infinite one passes, but makes Between a NaN.
template <class T>
bool HaveLength(const Edges<T>& e) {
  return Norm(e.e0) > 0 && Norm(e.e1) > 0;
}

}  // namespace definite::reference
