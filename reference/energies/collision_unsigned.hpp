#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/closest_points.hpp"
#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// The distance u = |n.e2| of the vertex to the plane of the triangle, with a sign (GivenSide) that
// no derivative sees. p = (k, eps, side). Domain: e0 and e1 span a plane, u > 0.
struct UnsignedVertexFace {
  static std::string Name() { return VertexFace::Name() + "/unsigned"; }
  static constexpr int kDofs = VertexFace::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const S u = Distance(VertexFace::EdgesOf(x));
    return OnSide(u, GivenSide(PlainEdgesOf<VertexFace>(x), p[2]));
  }
  // The length is |c2|, a minimum over the weights (Shi & Kim 2023, Eq. 17); to first order nothing
  // is lost by freezing them.
  template <class S, class T>
  static S FrameLength(const S* c, const T* at, const T* p) {
    return OnSide(LinearNorm(FrameEdges(c).e2), GivenSide(VertexFace::EdgesOf(at), p[2]));
  }
  template <class S, class T>
  static S RemainderLength(const S* c, const T* at, const T* p) {
    return OnSide(Norm(FrameEdges(c).e2), GivenSide(VertexFace::EdgesOf(at), p[2]));
  }
  template <class S, class T>
  static auto FrameAt(const S* x, const T* at, const T*) {
    return FrozenFrame<VertexFace>(x, at);
  }
  template <class S, class T>
  static auto FreeFrame(const S* x, const T*) {
    return FrozenFrame<VertexFace>(x, x);
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    const Edges<T> e = VertexFace::EdgesOf(x);
    return SpanPlane(e) && Distance(e) > 0;
  }
  template <class T>
  static double Conditioning(const T* x, const T*, const T& margin) {
    const Edges<T> e = VertexFace::EdgesOf(x);
    return SineOfEdges(e) * Nearness(std::min(Distance(e), margin), e);
  }

 private:
  template <class S>
  static S Distance(const Edges<S>& e) {
    const S l = AlongNormal(e);
    return l < 0 ? -l : l;
  }
};

// The distance u of two edges, with a sign (GivenSide) that no derivative sees: of two lines, of a
// point and a line or of two points, as the closest points lie inside their edges or at the ends.
// p = (k, eps, side). Domain: both edges have a length, u > 0.
struct UnsignedEdgeEdge {
  static std::string Name() { return EdgeEdge::Name() + "/unsigned"; }
  static constexpr int kDofs = EdgeEdge::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const Edges<T> plain = PlainEdgesOf<EdgeEdge>(x);
    return OnSide(Distance(EdgeEdge::EdgesOf(x), FindClosestPoints(plain)), GivenSide(plain, p[2]));
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T* at, const T* p) {
    const Edges<T> plain = EdgeEdge::EdgesOf(at);
    return OnSide(DistanceOf(FrameEdges(c), FindClosestPoints(plain)), GivenSide(plain, p[2]));
  }
  template <class S, class T>
  static std::array<S, 9> FrameAt(const S* x, const T* at, const T*) {
    const ClosestPoints<T> points = FindClosestPoints(EdgeEdge::EdgesOf(at));
    if (points.BothInside()) return FrozenFrame<EdgeEdge>(x, at);
    const auto [c0, c1, c2] = Involved(EdgeEdge::EdgesOf(x), points);
    const T beta = points.a_inside ? points.a : points.b_inside ? points.b : T(0);
    return Stack(Edges<S>{c0, c1, c2 - beta * c0});
  }
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    const T l = Length(x, p);
    return HaveLength(EdgeEdge::EdgesOf(x)) && (l < 0 || l > 0);
  }
  template <class T>
  static double Conditioning(const T* x, const T*, const T& margin) {
    const Edges<T> e = EdgeEdge::EdgesOf(x);
    const ClosestPoints<T> points = FindClosestPoints(e);
    return points.BothInside() ? SineOfEdges(e) * Nearness(margin, e)
                               : Nearness(std::min(Norm(Between(e, points)), margin), e);
  }
  template <class S, class T>
  static S Distance(const Edges<S>& e, const ClosestPoints<T>& points) {
    return DistanceOf(Involved(e, points), points);
  }
  // Of the vectors that it is made of.
  template <class S, class T>
  static S DistanceOf(const Edges<S>& c, const ClosestPoints<T>& points) {
    if (points.BothInside()) {
      const S l = AlongNormal(c);
      return l < 0 ? -l : l;
    }
    if (points.a_inside || points.b_inside) return DistanceToLine(c.e2, c.e0);
    return Norm(c.e2);
  }

 private:
  // The vectors that the distance is made of: both edges and e2; or the edge that has its closest
  // point inside and the vector from its start to the end that is closest; or the vector between
  // two ends.
  template <class S, class T>
  static Edges<S> Involved(const Edges<S>& e, const ClosestPoints<T>& points) {
    const Vec3<S> none{};
    if (points.BothInside()) return e;
    if (points.a_inside) return {e.e0, none, e.e2 + points.b * e.e1};
    if (points.b_inside) return {e.e1, none, points.a * e.e0 - e.e2};
    return {none, none, Between(e, points)};
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexFace, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexFace, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexFace, LogBarrier>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedEdgeEdge, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedEdgeEdge, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedEdgeEdge, LogBarrier>);

}  // namespace definite::reference
