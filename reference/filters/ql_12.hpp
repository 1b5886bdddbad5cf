#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by QL.
struct Ql12 : Numeric {
  static constexpr std::string_view kName = "ql_12";
};

DEFINITE_REFERENCE_FILTER(Ql12);

}  // namespace definite::reference
