#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix, in single precision.
struct NumericFloat : Numeric {
  static constexpr std::string_view kName = "numeric_float";
};

DEFINITE_REFERENCE_FILTER(NumericFloat);

}  // namespace definite::reference
