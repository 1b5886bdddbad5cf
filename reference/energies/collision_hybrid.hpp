#pragma once

#include <array>
#include <string>

#include "reference/energies/collision_signed.hpp"
#include "reference/energies/collision_unsigned_frozen.hpp"

namespace definite::reference {

// The signed length where both closest points lie inside their edges, elsewhere the frozen unsigned
// one with the sign that the signed length has. p = (k, eps, side): a negative side turns the
// normal around in both. Domain: both edges have a length; their distance is positive where
// unsigned.
struct HybridEdgeEdge {
  static std::string Name() { return EdgeEdge::Name() + "/hybrid"; }
  static constexpr int kDofs = EdgeEdge::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const Edges<T> plain = PlainEdgesOf<EdgeEdge>(x);
    if (IsSigned(plain)) return Signed<EdgeEdge>::Length(x, p);
    return UnsignedFrozenEdgeEdge::Length(x, Sided(plain, p).data());
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T* at, const T* p) {
    const Edges<T> plain = EdgeEdge::EdgesOf(at);
    if (IsSigned(plain)) return Signed<EdgeEdge>::FrameLength(c, at, p);
    return UnsignedFrozenEdgeEdge::FrameLength(c, at, Sided(plain, p).data());
  }
  template <class S, class T>
  static std::array<S, 9> FrameAt(const S* x, const T* at, const T* p) {
    return IsSigned(EdgeEdge::EdgesOf(at)) ? Signed<EdgeEdge>::FrameAt(x, at, p)
                                           : UnsignedFrozenEdgeEdge::FrameAt(x, at, p);
  }
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    return IsSigned(EdgeEdge::EdgesOf(x)) || UnsignedFrozenEdgeEdge::InDomain(x, p);
  }
  template <class T>
  static double Conditioning(const T* x, const T* p, const T& margin) {
    return IsSigned(EdgeEdge::EdgesOf(x)) ? Signed<EdgeEdge>::Conditioning(x, p, margin)
                                          : UnsignedFrozenEdgeEdge::Conditioning(x, p, margin);
  }

 private:
  template <class T>
  static bool IsSigned(const Edges<T>& e) {
    return FindClosestPoints(e).BothInside();
  }
  // p with the side that makes the unsigned length agree in sign with the signed one.
  template <class T>
  static std::array<T, 3> Sided(const Edges<T>& e, const T* p) {
    return {p[0], p[1], T(Orientation(e, p[2]))};
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<HybridEdgeEdge, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<HybridEdgeEdge, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<HybridEdgeEdge, LogBarrier>);

}  // namespace definite::reference
