#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A closest point at the border between two regions.
struct CornerRegion {
  static constexpr std::string_view kName = "corner_region";
  static constexpr std::string_view kMeaning =
      "how far the foot point is from the border of a region, in edges";
  static constexpr std::string_view kRemedy =
      "Nothing: the Hessian of an unsigned length may jump at the border, and a filter "
      "follows it.";
  static constexpr std::span<const std::string_view> kStencils = kContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    const double off = genes.negative ? -genes.delta : genes.delta;
    const double at = genes.u[10] < 0.5 ? 0 : 1;  // which end
    shape.a = at + off;
    if (genes.u[11] < 0.3) shape.b = 0.5 * off;  // near a corner of regions
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(CornerRegion);
