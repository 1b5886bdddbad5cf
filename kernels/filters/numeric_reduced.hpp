#pragma once

// Eigendecomposition of the 5x5 matrix in the range of the Hessian's modes, clamp, lift. Scalar
// only.

#include "kernels/core/eigen.hpp"
#include "kernels/core/reduced.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericReduced {
  static constexpr std::string_view kName = "numeric_reduced";
  static constexpr std::string_view kSource =
      "docs/derivations.md, section 1; Eigen SelfAdjointEigenSolver";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E> && OffersSet<E, T, Set::kSplit> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    const auto reduced = Reduce(Stacked(E::template HessianModes<Set::kSplit, Part::kAll>(x, p)));
    return Lift(reduced.basis, MapEigenvalues(reduced.h, ClampToPsd));
  }
};

DEFINITE_FILTER(NumericReduced);

}  // namespace definite
