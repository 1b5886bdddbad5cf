#pragma once

// The clamp of the 5x5 matrix in the range of the modes, by Householder tridiagonalisation and
// implicit QL that lanes share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Ql5 {
  static constexpr std::string_view kName = "ql_5";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.3";
  static constexpr bool kInPairs = true;
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E> && OffersSet<E, T, Set::kSplit>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampInRange<ByQl>(Stacked(E::template HessianModes<Set::kSplit, Part::kAll>(x, p)));
  }
};

DEFINITE_FILTER(Ql5);

}  // namespace definite
