#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An element that is almost a line, or a point where all stretches are small.
struct Collapsed {
  static constexpr std::string_view kName = "collapsed";
  static constexpr std::string_view kMeaning = "all stretches but one, or all";
  static constexpr std::string_view kRemedy =
      "Add an energy that resists collapse: that of St. Venant and Kirchhoff has no stiffness "
      "there.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    for (double& stretch : shape.stretches) stretch *= genes.delta;
    if (genes.negative) shape.stretches[0] = 1;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Collapsed);
