#pragma once

// The PSD matrix nearest to the Hessian in the Frobenius norm, without a 12x12 eigendecomposition:
// by the energy's own projection where it has one, else in the span of its modes.
//
// Source: docs/derivations.md, section 2.

#include <array>

#include "kernels/core/jacobi.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Nearest {
  static constexpr std::string_view kName = "nearest";
  static constexpr std::string_view kSource = "docs/derivations.md, section 2";
  static constexpr bool kOutputs = true, kStages = true;
  static constexpr std::array<Exemption, 0> kExempt{};

  template <class E, class T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    if constexpr (requires { E::BeginNearest(x, p); }) {
      return Refined(E::BeginNearest(x, p));
    } else if constexpr (requires { E::Nearest(x, p); }) {
      return E::Nearest(x, p);
    } else {
      return NearestPsd(Stacked(E::template HessianModes<Set::kExact, Part::kAll>(x, p)));
    }
  }

  // The same in stages, where the energy has them.
  template <class E, class T>
  requires requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    E::BeginNearest(x, p);
  }
  static DEFINITE_INLINE auto Begin(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return E::BeginNearest(x, p);
  }
};

DEFINITE_FILTER(Nearest);

}  // namespace definite
