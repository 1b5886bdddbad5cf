#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// An element that is almost flat, or just turned inside out.
struct Flattened {
  static constexpr std::string_view kName = "flattened";
  static constexpr std::string_view kMeaning = "the smallest stretch, of either sign";
  static constexpr std::string_view kRemedy =
      "Barrier energies: a line search that keeps stretches positive. The Hessian grows with a "
      "power "
      "of one over the stretch.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.stretches[2] = (genes.negative ? -1 : 1) * genes.delta;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Flattened);
