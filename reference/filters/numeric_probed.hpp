#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix, with a look at the pivots first.
struct NumericProbed : Numeric {
  static constexpr std::string_view kName = "numeric_probed";
};

DEFINITE_REFERENCE_FILTER(NumericProbed);

}  // namespace definite::reference
