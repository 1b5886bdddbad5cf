#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Edges that are nearly parallel.
struct EdgeAngle {
  static constexpr std::string_view kName = "edge_angle";
  static constexpr std::string_view kMeaning = "sine of the angle between two edges";
  static constexpr std::string_view kRemedy =
      "Mollify, or treat nearly parallel edges as vertices and edges: |H| grows with one "
      "over the angle squared.";
  static constexpr std::span<const std::string_view> kStencils = kEdgePairs;

  static void Deform(const Genes& genes, Shape& shape) { shape.sine = genes.delta; }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(EdgeAngle);
