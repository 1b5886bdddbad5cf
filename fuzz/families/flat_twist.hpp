#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A strand that is almost flat: its twist next to 0 or next to a half turn.
struct FlatTwist {
  static constexpr std::string_view kName = "flat_twist";
  static constexpr std::string_view kMeaning = "the tangent of half the twist, or one over it";
  static constexpr std::string_view kRemedy =
      "Natural coordinates, or Gauss-Newton: a clamp of the projected edges grows with one over "
      "the "
      "twist, along a motion that twists nothing.";
  static constexpr std::span<const std::string_view> kStencils = kTwisted;

  static void Deform(const Genes& genes, Shape& shape) {
    const double sign = genes.u[8] < 0.5 ? -1 : 1;
    shape.half_twist = sign * (genes.negative ? 1 / genes.PositiveDelta() : genes.delta);
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(FlatTwist);
