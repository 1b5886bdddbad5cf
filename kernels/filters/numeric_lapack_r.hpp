#pragma once

// Eigendecomposition of the full matrix by LAPACK's dsyevr, clamp, rebuild. Scalar only.

#include "kernels/core/lapack.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericLapackR {
  static constexpr std::string_view kName = "numeric_lapack_r";
  static constexpr std::string_view kSource =
      "LAPACK dsyevr (OpenBLAS, one thread), clamp, rebuild";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampByLapack(ToPacked(None::Apply<E>(x, p)),
                         LapackDriver::kRelativelyRobustRepresentations);
  }
};

DEFINITE_FILTER(NumericLapackR);

}  // namespace definite
