#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by its range.
struct NumericReduced : Numeric {
  static constexpr std::string_view kName = "numeric_reduced";
};

DEFINITE_REFERENCE_FILTER(NumericReduced);

}  // namespace definite::reference
