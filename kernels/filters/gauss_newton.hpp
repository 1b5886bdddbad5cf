#pragma once

// The curvature term alone, psi'' grad l grad l^T: one outer product.

#include "kernels/registry.hpp"

namespace definite {

struct GaussNewton {
  static constexpr std::string_view kName = "gauss_newton";
  static constexpr std::string_view kSource = "Gauss-Newton: psi'' grad l grad l^T";
  static constexpr Exemption kExempt[] = {
      {Property::kKeepsPsd, "drops the geometric term of the Hessian even where it is harmless"},
      {Property::kMajorises, "drops the positive part of the geometric term too"},
  };

  template <class E, class T>
  requires OffersCurvature<E, T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return E::template HessianModes<Set::kFrame, Part::kCurvature>(x, p);
  }
};

DEFINITE_FILTER(GaussNewton);

}  // namespace definite
