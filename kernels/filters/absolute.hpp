#pragma once

// Absolute values of the reduced frame's eigenvalues, in closed form.
//
// Source: Chen et al. 2024 for the idea, Shi & Kim 2023 for the eigensystem.

#include "kernels/registry.hpp"

namespace definite {

struct Absolute {
  static constexpr std::string_view kName = "absolute";
  static constexpr std::string_view kSource =
      "Chen et al. 2024; modes of Shi & Kim 2023, Eqs. 11-13";
  static constexpr Exemption kExempt[] = {
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    auto modes = E::template HessianModes<Set::kFrame, Part::kAll>(x, p);
    MapWeights(modes, [](const T& lambda) { return Abs(lambda); });
    return modes;
  }
};

DEFINITE_FILTER(Absolute);

}  // namespace definite
