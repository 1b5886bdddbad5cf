#pragma once

// The clamp in F by blocks over principal stretches: one of three stretches and three of two (in
// the plane one of two and one of two), decomposed numerically; contracted with U and V to the
// matrix over F, and pulled back, in Eigen. Scalar only.
//
// Source: Stomakhin et al. 2012, section 4, after Teran et al. 2005; quotients as there, with
// denominators kept away from 0.

#include "kernels/core/eigen.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Stomakhin {
  static constexpr std::string_view kName = "stomakhin";
  static constexpr std::string_view kSource = "Stomakhin et al. 2012, section 4; Eigen";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "quotients of differences of stretches, kept away from 0/0"},
      {Property::kPsd, "an eigendecomposition leaves eigenvalues of about -u |H|"},
      {Property::kKeepsPsd, "a denominator kept away from 0 changes the Hessian"},
      {Property::kRigidMotion, "the digits that a quotient loses change with the turn"},
      {Property::kMajorises, "a denominator kept away from 0 changes the Hessian"},
  };

  template <class E, class T>
  requires std::same_as<T, double> &&
      requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    E::StretchBlocks(x, p);
  }
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    const auto blocks = E::StretchBlocks(x, p);
    return ClampStretchBlocks(blocks.u, blocks.v, blocks.scaling, blocks.pairs,
                              std::get<0>(E::FrameTerms(x, p)).map);
  }
};

DEFINITE_FILTER(Stomakhin);

}  // namespace definite
