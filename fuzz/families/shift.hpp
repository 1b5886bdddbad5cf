#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Far from the origin, where coordinates lose digits.
struct ShiftFar {
  static constexpr std::string_view kName = "shift";
  static constexpr std::string_view kMeaning = "edges over the distance from the origin";
  static constexpr std::string_view kRemedy =
      "Subtract an origin of the pair before, or nothing: what is lost is lost in the "
      "coordinates.";
  static constexpr std::span<const std::string_view> kStencils = kEverything;

  static void Deform(const Genes& genes, Shape& shape) {
    const double far = 1 / genes.PositiveDelta();
    shape.shift = {far, (genes.u[10] - 0.5) * far, (genes.negative ? -1 : 1) * far};
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(ShiftFar);
