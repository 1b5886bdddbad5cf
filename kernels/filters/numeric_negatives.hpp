#pragma once

// The Hessian minus its negative eigenpairs, of which there are two: less to add up than a rebuild
// from all twelve. Scalar only.

#include "kernels/core/eigen.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericNegatives {
  static constexpr std::string_view kName = "numeric_negatives";
  static constexpr std::string_view kSource =
      "Eigen SelfAdjointEigenSolver, negative pairs subtracted";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
      {Property::kPsd, "the same error leaves eigenvalues of about -u |H|"},
  };

  template <class E, class T>
  requires kStudied<E> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return DropNegative(ToPacked(None::Apply<E>(x, p)));
  }
};

DEFINITE_FILTER(NumericNegatives);

}  // namespace definite
