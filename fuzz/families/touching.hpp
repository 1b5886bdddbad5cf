#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A distance of almost nothing.
struct Touching {
  static constexpr std::string_view kName = "touching";
  static constexpr std::string_view kMeaning = "distance over eps, of both signs";
  static constexpr std::string_view kRemedy =
      "Signed lengths: the formulas as printed divide by the distance.";
  static constexpr std::span<const std::string_view> kStencils = kAllContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.l = (genes.negative ? -genes.delta : genes.delta) * shape.eps;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Touching);
