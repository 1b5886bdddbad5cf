#pragma once

#include <string_view>

#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// The signed length of Shi & Kim 2023, Eq. 1: how far e2 reaches along the normal of e0 and e1.
// p = (k, eps, side): a negative side turns the normal around; 0 counts as positive. Domain: e0 and
// e1 span a plane (SpanPlane).
template <class Stencil>
struct Signed {
  static constexpr std::string_view kSigned = "signed";
  static constexpr std::string_view kName = JoinedName<Stencil::kName, kSigned>::kName;
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    return Along(Stencil::EdgesOf(x), p[2]);
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T* p) {
    return Along(Edges<S>{Block(c, 0), Block(c, 1), Block(c, 2)}, p[2]);
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
  static double Conditioning(const T* x, const T*) {
    return SineOfEdges(Stencil::EdgesOf(x));
  }

 private:
  template <class S, class T>
  static S Along(const Edges<S>& e, const T& side) {
    const Vec3<S> normal = Cross(e.e0, e.e1);
    const S l = Dot(normal, e.e2) / Norm(normal);
    return side < 0 ? -l : l;
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<Signed<VertexFace>, Quadratic>);

}  // namespace definite::reference
