#pragma once

#include "fuzz/family.hpp"

namespace definite::fuzz::families {

// A penalty just before it acts, or just after.
struct AtEps {
  static constexpr std::string_view kName = "at_eps";
  static constexpr std::string_view kMeaning = "how far the distance is from eps, relative to it";
  static constexpr std::string_view kRemedy =
      "Nothing: the penalty ends there. A quadratic or cubic Hessian jumps at eps, that "
      "of a barrier does not.";
  static constexpr std::span<const std::string_view> kStencils = kAllContacts;

  static void Deform(const Genes& genes, Shape& shape) {
    shape.l = shape.eps * (genes.negative ? 1 + genes.delta : 1 - genes.delta);
  }
};

}  // namespace definite::fuzz::families

DEFINITE_FAMILY(AtEps);
