#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An inverted element whose closest rotation is about to jump.
struct OppositeStretches {
  static constexpr std::string_view kName = "opposite_stretches";
  static constexpr std::string_view kMeaning = "sum of two stretches, the last one negative";
  static constexpr std::string_view kRemedy =
      "As rigid as possible and its kin have a true pole there: the twist goes to minus infinity, "
      "and "
      "a filter clamps it to 0.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.stretches[2] = genes.delta - shape.stretches[1];
    shape.stretches[0] = genes.negative ? 1 + genes.u[0] : shape.stretches[1];
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(OppositeStretches);
