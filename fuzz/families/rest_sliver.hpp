#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An element that is a sliver at rest.
struct RestSliver {
  static constexpr std::string_view kName = "rest_sliver";
  static constexpr std::string_view kMeaning = "height at rest over the other edges";
  static constexpr std::string_view kRemedy =
      "Mesh better, or clamp in x: a clamp of F pulled back adds up to (q + 1)^2/(4 q) times what "
      "is "
      "needed, q the condition number of the rest shape.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.rest_height = genes.negative ? 1 / genes.PositiveDelta() : genes.PositiveDelta();
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(RestSliver);
