#pragma once

// Between clamp and absolute value: (1 - w) max(lambda, 0) + w |lambda| on the reduced frame's
// eigenvalues. w = 0 is `analytic`, w = 1 `absolute`.
//
// Source: Chen et al. 2024 and the trust-region filters after it for the idea.

#include "kernels/registry.hpp"

namespace definite {

// w = kNumerator / kDenominator.
template <int kNumerator, int kDenominator>
struct Blend {
  static constexpr std::string_view kSource = "between clamp and absolute value";
  static constexpr Exemption kExempt[] = {
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    const T minus_w = T(-double{kNumerator} / double{kDenominator});
    auto modes = E::template HessianModes<Set::kFrame, Part::kAll>(x, p);
    MapWeights(modes,
               [&](const T& lambda) { return Select(lambda < T(0.0), minus_w * lambda, lambda); });
    return modes;
  }
};

struct BlendHalf : Blend<1, 2> {
  static constexpr std::string_view kName = "blend_half";
};

DEFINITE_FILTER(BlendHalf);

}  // namespace definite
