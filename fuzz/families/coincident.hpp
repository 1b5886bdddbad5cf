#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Two vertices in one place.
struct Coincident {
  static constexpr std::string_view kName = "coincident";
  static constexpr std::string_view kMeaning =
      "distance of two vertices of the two primitives, in edges";
  static constexpr std::string_view kRemedy =
      "Nothing for signed lengths. An unsigned length has no direction at 0: keep "
      "barriers apart, or take the signed length.";
  static constexpr std::span<const std::string_view> kStencils = kAllContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    // A vertex on a vertex: nothing between them but delta, along the edges and across.
    const double off = genes.negative ? -genes.delta : genes.delta;
    shape.a = genes.u[10] * off;
    shape.b = genes.u[11] * off;
    shape.l = off * (genes.u[9] - 0.5);
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Coincident);
