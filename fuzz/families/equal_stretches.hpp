#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Stretches that are almost equal: singular vectors are arbitrary, quotients of differences 0/0.
struct EqualStretches {
  static constexpr std::string_view kName = "equal_stretches";
  static constexpr std::string_view kMeaning = "difference of stretches";
  static constexpr std::string_view kRemedy =
      "Use forms that divide by no difference of stretches.";
  static constexpr std::span<const std::string_view> kStencils = kSimplices;

  static void Deform(const Genes& genes, Shape& shape) {
    const double s = shape.stretches[0];
    shape.stretches = {s, s * (1 - genes.delta * genes.u[1]),
                       (genes.negative ? -1 : 1) * s * (1 - genes.delta)};
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(EqualStretches);
