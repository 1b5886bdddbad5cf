#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An element that is hardly deformed: twists vanish there, and their signs are rounding.
struct AtRest {
  static constexpr std::string_view kName = "at_rest";
  static constexpr std::string_view kMeaning = "how far stretches are from 1";
  static constexpr std::string_view kRemedy =
      "Nothing: forms in stretches lose nothing there; energies by invariants lose all of the "
      "value.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.stretches = {1 + genes.delta * genes.u[0], 1 + genes.delta * (genes.u[1] - 0.5),
                       1 - genes.delta * genes.u[2]};
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(AtRest);
