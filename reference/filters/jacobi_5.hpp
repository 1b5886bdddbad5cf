#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by Jacobi rotations in the range of the Hessian.
struct Jacobi5 : Numeric {
  static constexpr std::string_view kName = "jacobi_5";
};

DEFINITE_REFERENCE_FILTER(Jacobi5);

}  // namespace definite::reference
