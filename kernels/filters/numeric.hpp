#pragma once

// Eigendecomposition of the full matrix, clamp, rebuild: the paper's baseline. Scalar only.

#include "kernels/core/eigen.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Numeric {
  static constexpr std::string_view kName = "numeric";
  static constexpr std::string_view kSource = "Eigen SelfAdjointEigenSolver, clamp, rebuild";
  static constexpr bool kOutputs = true;
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
      {Property::kPsd, "the same error leaves eigenvalues of about -u |H|"},
  };

  template <class E, class T>
  requires std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return MapEigenvalues(ToPacked(None::Apply<E>(x, p)), ClampToPsd);
  }
};

DEFINITE_FILTER(Numeric);

}  // namespace definite
