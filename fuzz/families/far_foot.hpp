#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A foot point far outside.
struct FarFoot {
  static constexpr std::string_view kName = "far_foot";
  static constexpr std::string_view kMeaning = "one over the foot point, in edges";
  static constexpr std::string_view kRemedy =
      "Leave such pairs out: no contact is there, and the length is good to few digits.";
  static constexpr std::span<const std::string_view> kStencils = kContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    const double far = 1 / genes.PositiveDelta();
    shape.a = genes.negative ? 1 - far : far;
    shape.b = genes.u[10] < 0.5 ? shape.b : -0.7 * far;
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(FarFoot);
