#pragma once

#include <string>

#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// The signed length of Shi & Kim 2023, Eq. 1: how far e2 reaches along the normal of e0 and e1.
// p = (k, eps, side): a negative side turns the normal around; 0 counts as positive. Domain: e0 and
// e1 span a plane (SpanPlane).
template <class Stencil>
struct Signed {
  static std::string Name() { return Stencil::Name() + "/signed"; }
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    return OnSide(AlongNormal(Stencil::EdgesOf(x)), p[2]);
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T*, const T* p) {
    return OnSide(AlongNormal(FrameEdges(c)), p[2]);
  }
  template <class S, class T>
  static auto FrameAt(const S* x, const T* at, const T*) {
    return FrozenFrame<Stencil>(x, at);
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    return SpanPlane(Stencil::EdgesOf(x));
  }
  template <class T>
  static double Conditioning(const T* x, const T*, const T& margin) {
    const Edges<T> e = Stencil::EdgesOf(x);
    return SineOfEdges(e) * Nearness(margin, e);
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<VertexFace>, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<VertexFace>, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<VertexFace>, LogBarrier>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<EdgeEdge>, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<EdgeEdge>, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<EdgeEdge>, LogBarrier>);

}  // namespace definite::reference
