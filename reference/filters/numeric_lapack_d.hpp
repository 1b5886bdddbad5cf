#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by LAPACK's dsyevd.
struct NumericLapackD : Numeric {
  static constexpr std::string_view kName = "numeric_lapack_d";
};

DEFINITE_REFERENCE_FILTER(NumericLapackD);

}  // namespace definite::reference
