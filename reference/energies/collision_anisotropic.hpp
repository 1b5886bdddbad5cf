#pragma once

#include <algorithm>
#include <string>

#include "reference/energies/collision_signed.hpp"
#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// h = m l + (1 - m) u of the signed length l and the distance u = |l| (McAdams et al. 2011; Shi &
// Kim 2023, Eq. 34): l where it is positive, (2 m - 1) l where it is negative. p = (k, eps, side,
// m). Domain: that of the signed length, u > 0, and m in [1/2, 1], since below 1/2 penetration is
// drawn further in.
template <class Stencil>
struct Anisotropic {
  static std::string Name() { return Stencil::Name() + "/anisotropic"; }
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr int kParams = 4;
  static constexpr int kFrameDofs = 9;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const S l = Signed<Stencil>::Length(x, p);
    return p[3] * l + (1 - p[3]) * (l < 0 ? -l : l);
  }
  // Freezing the weights loses nothing of l, nor of u = |c2| to first order.
  template <class S, class T>
  static S FrameLength(const S* c, const T* at, const T* p) {
    const S l = Signed<Stencil>::FrameLength(c, at, p);
    return p[3] * l + (1 - p[3]) * LinearNorm(FrameEdges(c).e2);
  }
  template <class S, class T>
  static S RemainderLength(const S* c, const T*, const T* p) {
    return (1 - p[3]) * Norm(FrameEdges(c).e2);
  }
  template <class S, class T>
  static auto FrameAt(const S* x, const T* at, const T*) {
    return FrozenFrame<Stencil>(x, at);
  }
  template <class S, class T>
  static auto FreeFrame(const S* x, const T*) {
    return FrozenFrame<Stencil>(x, x);
  }
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    return Signed<Stencil>::InDomain(x, p) && Distance(x, p) > 0 && p[3] >= T(0.5) && p[3] <= 1;
  }
  template <class T>
  static double Conditioning(const T* x, const T* p, const T& margin) {
    const Edges<T> e = Stencil::EdgesOf(x);
    return SineOfEdges(e) * Nearness(std::min(Distance(x, p), margin), e);
  }

 private:
  template <class T>
  static T Distance(const T* x, const T* p) {
    const T l = Signed<Stencil>::Length(x, p);
    return l < 0 ? -l : l;
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<Anisotropic<VertexFace>, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Anisotropic<VertexFace>, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Anisotropic<EdgeEdge>, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<Anisotropic<EdgeEdge>, Cubic>);

}  // namespace definite::reference
