#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by QL in the range of the Hessian.
struct Ql5 : Numeric {
  static constexpr std::string_view kName = "ql_5";
};

DEFINITE_REFERENCE_FILTER(Ql5);

}  // namespace definite::reference
