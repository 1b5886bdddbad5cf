#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by what is subtracted.
struct NumericNegatives : Numeric {
  static constexpr std::string_view kName = "numeric_negatives";
};

DEFINITE_REFERENCE_FILTER(NumericNegatives);

}  // namespace definite::reference
