#pragma once

// Clamp in x-space: the geometric term in orthogonal vectors, each clamped, and the curvature. As
// cheap in terms as the paper's filter, nearer to the projection, and blind to the numbering.
//
// Source: docs/derivations.md, section 1.

#include <array>

#include "kernels/registry.hpp"

namespace definite {

struct Split {
  static constexpr std::string_view kName = "split";
  static constexpr std::string_view kSource = "docs/derivations.md, section 1";
  static constexpr bool kOutputs = true;
  static constexpr std::array<Exemption, 0> kExempt{};

  template <class E, class T>
  requires OffersSet<E, T, Set::kSplit>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return MapModes(E::template HessianModes<Set::kSplit, Part::kPositive>(x, p),
                    [](const T& lambda) { return Select(lambda < T(0.0), T(0.0), lambda); });
  }
};

DEFINITE_FILTER(Split);

}  // namespace definite
