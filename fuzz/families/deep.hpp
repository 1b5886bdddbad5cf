#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Deep penetration of a primitive that is tiny beside its depth.
struct Deep {
  static constexpr std::string_view kName = "deep";
  static constexpr std::string_view kMeaning = "edges over the depth they have gone through";
  static constexpr std::string_view kRemedy =
      "Analytic, split or nearest: what clamps eigenvalues in double has an error of u "
      "|H|, and nearly all of H is thrown away.";
  static constexpr std::span<const std::string_view> kStencils = kPairs;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.l = -shape.length0 / genes.PositiveDelta();
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Deep);
