#pragma once

// The clamp of the 5x5 matrix in the range of the modes, by cyclic Jacobi rotations that lanes
// share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Jacobi5 {
  static constexpr std::string_view kName = "jacobi_5";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.5";
  static constexpr bool kInPairs = true;
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E> && OffersSet<E, T, Set::kSplit>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampInRange<ByJacobi>(Stacked(E::template HessianModes<Set::kSplit, Part::kAll>(x, p)));
  }
};

DEFINITE_FILTER(Jacobi5);

}  // namespace definite
