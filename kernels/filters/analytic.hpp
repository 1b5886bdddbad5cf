#pragma once

// Clamp in the reduced frame, then pull back: the filter of Shi & Kim 2023 and of Smith et al.
// 2019, on the stable mode set.

#include "kernels/registry.hpp"

namespace definite {

struct Analytic {
  static constexpr std::string_view kName = "analytic";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 11-13, 17; stable modes";
  static constexpr bool kOutputs = true, kStages = true, kTimesFrame = true;
  static constexpr Exemption kExempt[] = {
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    auto modes = E::template HessianModes<Set::kFrame, Part::kPositive>(x, p);
    MapWeights(modes, [](const T& lambda) { return Max(T(0.0), lambda); });  // a NaN stays
    return modes;
  }
};

DEFINITE_FILTER(Analytic);

}  // namespace definite
