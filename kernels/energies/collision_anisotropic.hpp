#pragma once

// psi(h) of the mixed length h = m l + (1 - m) |l|, l the signed length: for m = 1 signed, below
// that stiffer against sliding.
//
// Source: Shi & Kim 2023, Eqs. 34 and 35, after McAdams et al. 2011. Erratum: the cross term of
// Eq. 35 needs sgn(l).
// Differs: for l < 0 the mixed length is (2 m - 1) l, so m < 1/2 would push deeper; the domain is m
// in [1/2, 1]. The exact Hessian is that of the signed length with psi' (m + sgn(l) (1 - m)); the
// frame set is the paper's, three terms filtered separately.
// Parameters: k, eps, side (as of the signed length), m, then the penalty's own.
// Domain: that of the signed length, |l| above kLeastLength, m in [1/2, 1]. Inactive where h >=
// eps.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/unsigned_plane.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/quadratic.hpp"
#include "kernels/stencils/edge_edge.hpp"
#include "kernels/stencils/vertex_face.hpp"

namespace definite {

template <class Primitive, class Penalty>
struct CollisionAnisotropic {
  using Stencil = Primitive;
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr auto kParameters = CollisionParameters<Penalty, 1>(
      Signed<Primitive>::kSide, {Parameter{"m", 0.8, 0, "anisotropy: 1 is the signed length"}});
  static constexpr int kParams = static_cast<int>(kParameters.size());

  static std::string Name() {
    return "collision/" + std::string(Stencil::kName) + "/anisotropic/" +
           std::string(Penalty::kName);
  }
  static std::string Source() {
    return "Shi & Kim 2023, Eqs. 34, 35 corrected; psi: " + std::string(Penalty::kSource);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Mixed<T> mixed = MixedOf(x, p);
    const T h = mixed.f.FromUnits(mixed.h);
    return Select((h >= p[1]) | mixed.f.outside, T(0.0), Penalty::Value(h, Arguments::AsGiven(p)));
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Mixed<T> mixed = MixedOf(x, p);
    const T slope = mixed.f.FromUnits(mixed.psi1 * mixed.slope);
    return Kron(slope * OverVertices<Stencil>(mixed.f.w), mixed.f.n);
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, kDofs>& x,
                                                    const Vec<T, kParams>& p) {
    const Mixed<T> mixed = MixedOf(x, p);
    return {Select(mixed.idle, T(0.0), T(1.0)), Select(mixed.f.outside, T(0.0), T(1.0)), T(0.0)};
  }

  template <Set kSet, Part kPart, class T>
  requires(kSet != Set::kPrinted) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    Mixed<T> mixed = MixedOf(x, p);
    if constexpr (kSet == Set::kFrame) {
      return PullBack<true>(mixed.f, FrameModesOf<kPart>(mixed));
    } else {
      if constexpr (kSet == Set::kSplit) {
        TurnInX<kBothFree>(mixed.f);
      }
      return PullBack<kSet != Set::kSplit>(mixed.f, Exact<kPart>(mixed));
    }
  }

  template <class T>
  static DEFINITE_INLINE auto BeginNearest(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Mixed<T> mixed = MixedOf(x, p);
    return CollisionProjection<Stencil, kBothFree, 2, T>(mixed.f, TurnedRowsOf<kBothFree>(mixed.f),
                                                         mixed.psi1 * mixed.slope, mixed.psi2);
  }

  // Eq. 35 on the frame: psi_l H_l with the curvature, psi_u H_u, and -psi_u H_u with the map D.
  template <class T>
  static auto FrameTerms(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Mixed<T> mixed = MixedOf(x, p);
    const T of_u = mixed.psi1_u;
    auto terms = std::tuple(
        ToFrameTerm(mixed.f, PairModes<Part::kAll, kBothFree>(mixed.f, mixed.psi1_l, mixed.psi2)),
        ToFrameTerm(mixed.f, PairModes<Part::kAll, kBothFixed>(mixed.f, of_u, T(0.0))),
        ToFrameTerm(mixed.f, PairModes<Part::kAll, kBothFixed>(mixed.f, -of_u, T(0.0))));
    UnsignedPlane<Primitive>::Remainder(x, mixed.f.outside, std::get<2>(terms).map);
    return terms;
  }

 private:
  using Arguments = PenaltyParameters<Penalty, 1>;

  template <class T>
  struct Mixed {
    CollisionFrame<T, Stencil, 2> f;
    MaskOf<T> idle;
    T h, slope;        // h and dh/dl
    T psi1;            // psi'(h)/unit
    T psi1_l, psi1_u;  // of the part along l, and of that along u = |l| as a slope of l
    T psi2;            // psi''(h) (dh/dl)^2
  };

  template <class T>
  static DEFINITE_INLINE Mixed<T> MixedOf(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    Mixed<T> mixed;
    auto& f = mixed.f;
    f = Signed<Primitive>::FrameOf(x, p[2]);
    const T m = p[3];
    const auto on_plane = Abs(f.l) <= T(kLeastLength);
    f.outside = f.outside | on_plane | (m < T(0.5)) | (m > T(1.0));
    f.l = Select(on_plane, T(1.0), f.l);
    const auto below = f.l < T(0.0);
    mixed.slope = Select(below, (m + m) - T(1.0), T(1.0));
    mixed.h = mixed.slope * f.l;
    const auto q = Arguments::InUnits(f, p);
    mixed.idle = (mixed.h >= q[1]) | f.outside;
    const auto slopes = Penalty::Derivatives(mixed.h, q);
    mixed.psi1 = Select(mixed.idle, T(0.0), slopes.psi1);
    mixed.psi1_l = m * mixed.psi1;
    const T of_u = (T(1.0) - m) * mixed.psi1;
    mixed.psi1_u = Select(below, -of_u, of_u);
    mixed.psi2 = Select(mixed.idle, T(0.0), slopes.psi2 * (mixed.slope * mixed.slope));
    return mixed;
  }

  template <Part kPart, class T>
  static DEFINITE_INLINE auto Exact(const Mixed<T>& mixed) {
    return PairModes<kPart, kBothFree>(mixed.f, mixed.psi1 * mixed.slope, mixed.psi2);
  }

  template <Part kPart, class T>
  static DEFINITE_INLINE auto FrameModesOf(const Mixed<T>& mixed) {
    const auto along_l = PairModes<kPart, kBothFree>(mixed.f, mixed.psi1_l, mixed.psi2);
    if constexpr (kPart == Part::kCurvature) {
      return along_l;
    } else {
      const auto along_u =
          UnsignedPlane<Primitive>::template SplitModes<kPart>(mixed.f, mixed.psi1_u, T(0.0));
      constexpr int kOfL = std::size(decltype(along_l.mode){});
      constexpr int kOfU = std::size(decltype(along_u.mode){}) - 1;  // without the curvature
      FrameModes<T, kOfL + kOfU, true> both;
      for (int i = 0; i < kOfL; ++i) both.mode[i] = along_l.mode[i];
      for (int i = 0; i < kOfU; ++i) both.mode[kOfL + i] = along_u.mode[1 + i];
      return both;
    }
  }
};

// No logarithmic barrier: the mixed length may be zero where the pair penetrates.
DEFINITE_ENERGY(CollisionAnisotropic<VertexFace, Quadratic>);
DEFINITE_ENERGY(CollisionAnisotropic<VertexFace, Cubic>);
DEFINITE_ENERGY(CollisionAnisotropic<EdgeEdge, Quadratic>);
DEFINITE_ENERGY(CollisionAnisotropic<EdgeEdge, Cubic>);

}  // namespace definite
