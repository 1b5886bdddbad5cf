#pragma once

// The exact Hessian, unfiltered.

#include "kernels/registry.hpp"

namespace definite {

struct None {
  static constexpr std::string_view kName = "none";
  static constexpr std::string_view kSource = "the energy's Hessian";
  static constexpr Exemption kExempt[] = {
      {Property::kPsd, "a Hessian is indefinite in general: that is what filters are for"},
  };

  template <class E, class T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return E::template HessianModes<Set::kExact, Part::kAll>(x, p);
  }
};

DEFINITE_FILTER(None);

}  // namespace definite
