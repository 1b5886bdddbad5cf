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
  static S Value(const S* x, const T* p) {
    return ValueOf(EdgeEdge::EdgesOf(x), PlainEdgesOf<EdgeEdge>(x), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T* at, const T* p) {
    return ValueOf(FrameEdges(c), EdgeEdge::EdgesOf(at), p);
  }
  // At an end, freezing the weights of the closest points would lose something: the edges as they
  // are.
  template <class S, class T>
  static std::array<S, 9> FrameAt(const S* x, const T* at, const T*) {
    return FindClosestPoints(EdgeEdge::EdgesOf(at)).BothInside() ? FrozenFrame<EdgeEdge>(x, at)
                                                                 : Stack(EdgeEdge::EdgesOf(x));
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
  template <class T>
  static double Conditioning(const T* x, const T* p) {
    return UnsignedEdgeEdge::Conditioning(x, p,
                                          P::Margin(UnsignedEdgeEdge::Length(x, p), p, p + 4));
  }

 private:
  // Of edges e that vary, where the closest points and the side are those of the edges `at`.
  template <class S, class T>
  static S ValueOf(const Edges<S>& e, const Edges<T>& at, const T* p) {
    const S u = UnsignedEdgeEdge::Distance(e, FindClosestPoints(at));
    const S psi = P::Value(OnSide(u, GivenSide(at, p[2])), p, p + 4);
    const Vec3<S> cross = Cross(e.e0, e.e1);
    const S part = Dot(cross, cross) / p[3];
    return part >= 1 ? psi : part * (2 - part) * psi;
  }
};

DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<Quadratic>);
DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<Cubic>);
DEFINITE_REFERENCE_ENERGY(MollifiedEdgeEdge<LogBarrier>);

}  // namespace definite::reference
