#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/closest_points.hpp"
#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// The distance u of two edges, with a sign (GivenSide) that no derivative sees; to derivatives the
// closest points stay where they are on their edges (Shi & Kim 2023, Eq. 53). p = (k, eps, side).
// Domain: both edges have a length, u > 0.
struct UnsignedFrozenEdgeEdge {
  static std::string Name() { return EdgeEdge::Name() + "/unsigned_frozen"; }
  static constexpr int kDofs = EdgeEdge::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const Edges<T> plain = PlainEdgesOf<EdgeEdge>(x);
    const S u = Norm(Between(EdgeEdge::EdgesOf(x), FindClosestPoints(plain)));
    return OnSide(u, GivenSide(plain, p[2]));
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T* at, const T* p) {
    return OnSide(Norm(FrameEdges(c).e2), GivenSide(EdgeEdge::EdgesOf(at), p[2]));
  }
  template <class S, class T>
  static std::array<S, 9> FrameAt(const S* x, const T* at, const T*) {
    const ClosestPoints<T> points = FindClosestPoints(EdgeEdge::EdgesOf(at));
    return Stack(Edges<S>{{}, {}, Between(EdgeEdge::EdgesOf(x), points)});
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
    const double nearness = Nearness(std::min(Norm(Between(e, points)), margin), e);
    return points.BothInside() ? SineOfEdges(e) * nearness : nearness;
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedFrozenEdgeEdge, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedFrozenEdgeEdge, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedFrozenEdgeEdge, LogBarrier>);

}  // namespace definite::reference
