#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An edge almost without length.
struct ShortEdge {
  static constexpr std::string_view kName = "short_edge";
  static constexpr std::string_view kMeaning = "one edge over the other, or over the distance";
  static constexpr std::string_view kRemedy =
      "Collapse such edges when meshing. The paper's frame weighs a short edge by one "
      "over its length, split and nearest do not.";
  static constexpr std::span<const std::string_view> kStencils = kContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    (genes.negative ? shape.length0 : shape.length1) *= genes.delta;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(ShortEdge);
