#pragma once

// The curvature term through the reduced frame, 12x9 * 9x9 * 9x12 in Eigen: what the paper most
// likely timed as Gauss-Newton. Scalar only.

#include "kernels/core/eigen.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct GaussNewtonFrame {
  static constexpr std::string_view kName = "gauss_newton_frame";
  static constexpr std::string_view kSource =
      "Gauss-Newton: psi'' g g^T, Shi & Kim 2023, Eqs. 13, 17-19; Eigen products";
  static constexpr Exemption kExempt[] = {
      {Property::kKeepsPsd, "drops the geometric term of the Hessian even where it is harmless"},
      {Property::kMajorises, "drops the positive part of the geometric term too"},
  };

  template <class E, class T>
  requires WithFrame<E, T> && IsPenalty<E, T> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    // The curvature is the first mode of the first term.
    const auto term = std::get<0>(E::FrameTerms(x, p));
    return PullBackInEigen(term.modes.lambda, term.modes.v, 1, term.map, nullptr);
  }
};

DEFINITE_FILTER(GaussNewtonFrame);

}  // namespace definite
