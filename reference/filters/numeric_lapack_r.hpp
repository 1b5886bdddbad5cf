#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by LAPACK's dsyevr.
struct NumericLapackR : Numeric {
  static constexpr std::string_view kName = "numeric_lapack_r";
};

DEFINITE_REFERENCE_FILTER(NumericLapackR);

}  // namespace definite::reference
