#pragma once

// The paper's filter by its formulas as printed, clamped by sign. Kept to show where they fail (NaN
// at l = 0, lost digits near it and at small angles); never a default.

#include "kernels/registry.hpp"

namespace definite {

struct AnalyticPrinted {
  static constexpr std::string_view kName = "analytic_printed";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 2, 8-13, 17-19 as printed";
  static constexpr Exemption kExempt[] = {
      {Property::kFinite, "0/0 at l = 0, as printed"},
      {Property::kAccurate, "loses digits like u/|l| and u/sin^2, as printed"},
      {Property::kPsd, "NaN where it is not finite"},
      {Property::kMajorises, "an inaccurate clamp majorises only roughly"},
      {Property::kRigidMotion, "the digits it loses change with the way the pair lies"},
      {Property::kScale, "over- and underflows without a common unit of length"},
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  requires OffersSet<E, T, Set::kPrinted>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    auto modes = E::template HessianModes<Set::kPrinted, Part::kAll>(x, p);
    MapWeights(modes, [](const T& lambda) { return Max(T(0.0), lambda); });
    return modes;
  }
};

DEFINITE_FILTER(AnalyticPrinted);

}  // namespace definite
