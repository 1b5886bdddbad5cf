#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A strand of unequal lengths.
struct UnequalStrand {
  static constexpr std::string_view kName = "unequal_strand";
  static constexpr std::string_view kMeaning = "one edge of a strand over the other";
  static constexpr std::string_view kRemedy =
      "Keep the edges of a strand alike: its Hessian grows with one over the square of "
      "the shorter.";
  static constexpr std::span<const std::string_view> kStencils = kStrands;

  static void Deform(const Genes& genes, Shape& shape) {
    (genes.negative ? shape.length0 : shape.length1) *= genes.delta;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(UnequalStrand);
