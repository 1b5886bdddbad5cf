#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A strand that is nearly straight, or folded back on itself.
struct Straight {
  static constexpr std::string_view kName = "straight";
  static constexpr std::string_view kMeaning = "pi less the angle of a strand, or the angle";
  static constexpr std::string_view kRemedy =
      "Mind kinks: the Hessian of bending grows with one over the sine of the angle, and that of "
      "twisting with one over its square; straight hair has no twist.";
  static constexpr std::span<const std::string_view> kStencils = kStrands;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.sine = genes.delta;
    shape.obtuse = !genes.negative;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Straight);
