#pragma once

// The clamp of the full matrix, by Householder tridiagonalisation and implicit QL that lanes share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Ql12 {
  static constexpr std::string_view kName = "ql_12";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.3";
  static constexpr bool kInPairs = true;
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
  };

  template <class E, class T>
  requires kStudied<E>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampFull<ByQl>(ToPacked(None::Apply<E>(x, p)));
  }
};

DEFINITE_FILTER(Ql12);

}  // namespace definite
