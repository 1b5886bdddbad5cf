#pragma once

#include <cmath>

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// Other units of length: up to 1e292, or down to where lengths are subnormal and, at the end,
// vanish.
struct Scale {
  static constexpr std::string_view kName = "scale";
  static constexpr std::string_view kMeaning = "lengths times its 20th power, or over its 18th";
  static constexpr std::string_view kRemedy =
      "Any filter here but the formulas as printed, which need lengths near 1.";
  static constexpr std::span<const std::string_view> kStencils = kEverything;

  static void Deform(const Genes& genes, Shape& shape) {
    if (genes.delta == 0) return;
    const int exponent = std::ilogb(genes.delta);
    shape.unit = std::ldexp(genes.delta, (genes.negative ? -19 : 19) * exponent);
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(Scale);
