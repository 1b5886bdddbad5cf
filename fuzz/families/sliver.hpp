#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A triangle almost without area, none of its edges short.
struct Sliver {
  static constexpr std::string_view kName = "sliver";
  static constexpr std::string_view kMeaning = "height of a triangle over its longest edge";
  static constexpr std::string_view kRemedy =
      "Mesh better: |H| grows with one over the height squared. No filter here loses "
      "digits but the formulas as printed.";
  static constexpr std::span<const std::string_view> kStencils = kFaces;

  static void Deform(const Genes& genes, Shape& shape) { shape.sine = genes.delta; }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Sliver);
