#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by Jacobi rotations.
struct Jacobi12 : Numeric {
  static constexpr std::string_view kName = "jacobi_12";
};

DEFINITE_REFERENCE_FILTER(Jacobi12);

}  // namespace definite::reference
