#pragma once

#include <array>
#include <string>

#include "reference/closest_points.hpp"
#include "reference/energies/collision_unsigned.hpp"
#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// m(c) psi(l), where l is the unsigned length of two edges and c = |e0 x e1|^2, so that parallel
// edges do not act: m = c/ex (2 - c/ex) below the threshold c = ex, else 1 (Li et al. 2020,
// Incremental Potential Contact). p = (k, eps, side, ex), then P's own. Domain: that of the
// unsigned length and of P, ex > 0.
template <class P>
struct MollifiedEdgeEdge {
  static std::string Name() { return EdgeEdge::Name() + "/mollified/" + P::Name(); }
  static constexpr int kDofs = EdgeEdge::kDofs;
  static constexpr int kParams = 4 + P::kParams;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    return UnsignedEdgeEdge::Length(x, p);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    const Edges<S> e = EdgeEdge::EdgesOf(x);
    const Edges<T> plain = PlainEdgesOf<EdgeEdge>(x);
    return ValueOf(UnsignedEdgeEdge::Distance(e, FindClosestPoints(plain)), e, plain, p);
  }
  // c is that of the first two vectors of the frame: a multiple of one that is added to the other
  // changes nothing. So it is with the edge that a closest point slides along and the vector
  // between both points, and nothing is lost by frozen weights.
  template <class S, class T>
  static S FrameValue(const S* c, const T* at, const T* p) {
    const Edges<T> plain = EdgeEdge::EdgesOf(at);
    const Edges<S> e = FrameEdges(c);
    return ValueOf(UnsignedEdgeEdge::DistanceOf(e, FindClosestPoints(plain)), e, plain, p);
  }
  template <class S, class T>
  static std::array<S, 9> FrameAt(const S* x, const T* at, const T*) {
    const Edges<T> plain = EdgeEdge::EdgesOf(at);
    const Edges<S> e = EdgeEdge::EdgesOf(x);
    const ClosestPoints<T> points = FindClosestPoints(plain);
    const Vec3<S> between = Between(e, points);
    const bool starts_at_b = points.b_inside && !points.a_inside;
    const T along = Dot(plain.e0, plain.e1);
    if (starts_at_b)
      return Stack(Edges<S>{e.e1, e.e0 - along / Dot(plain.e1, plain.e1) * e.e1, between});
    return Stack(Edges<S>{e.e0, e.e1 - along / Dot(plain.e0, plain.e0) * e.e0, between});
  }
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    return UnsignedEdgeEdge::InDomain(x, p) && p[3] > 0 &&
           P::InDomain(UnsignedEdgeEdge::Length(x, p), p, p + 4);
  }
  template <class T>
  static bool Active(const T* x, const T* p) {
    return UnsignedEdgeEdge::Length(x, p) < p[1];
  }
  // Where the distance is to an end, the angle counts as far as the mollifier changes: the
  // direction of its gradient is good to a roundoff over the sine, its second derivative to c/ex of
  // that.
  template <class T>
  static double Conditioning(const T* x, const T* p) {
    const double conditioning =
        UnsignedEdgeEdge::Conditioning(x, p, P::Margin(UnsignedEdgeEdge::Length(x, p), p, p + 4));
    const Edges<T> e = EdgeEdge::EdgesOf(x);
    const double part = static_cast<double>(SquaredArea(e) / p[3]);
    const bool turns = part < 1 && !FindClosestPoints(e).BothInside() && SineOfEdges(e) < part;
    return turns ? conditioning * SineOfEdges(e) / part : conditioning;
  }

 private:
  template <class S>
  static S SquaredArea(const Edges<S>& e) {
    const Vec3<S> cross = Cross(e.e0, e.e1);
    return Dot(cross, cross);
  }
  // Of the distance u and edges e that vary, where the closest points and the side are those of the
  // edges `at`.
  template <class S, class T>
  static S ValueOf(const S& u, const Edges<S>& e, const Edges<T>& at, const T* p) {
    const S psi = P::Value(OnSide(u, GivenSide(at, p[2])), p, p + 4);
    const S part = SquaredArea(e) / p[3];
    return part >= 1 ? psi : part * (2 - part) * psi;
  }
};

DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<Quadratic>);
DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<Cubic>);
DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<LogBarrier>);

}  // namespace definite::reference
