#pragma once

// The clamp of the full matrix, by cyclic Jacobi rotations that lanes share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Jacobi12 {
  static constexpr std::string_view kName = "jacobi_12";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.5";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampFull<ByJacobi>(ToPacked(None::Apply<E>(x, p)));
  }
};

DEFINITE_FILTER(Jacobi12);

}  // namespace definite
