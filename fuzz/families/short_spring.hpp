#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A spring that is pressed to nothing, or drawn out as far.
struct ShortSpring {
  static constexpr std::string_view kName = "short_spring";
  static constexpr std::string_view kMeaning = "length of a spring, or one over it";
  static constexpr std::string_view kRemedy =
      "Keep springs from collapsing: the Hessian of one grows with one over its length, all of it "
      "negative.";
  static constexpr std::span<const std::string_view> kStencils = kSprings;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.length0 = genes.negative ? 1 / genes.PositiveDelta() : genes.delta;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(ShortSpring);
