#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The same matrix by QL in the frame.
struct Ql9 : Analytic {
  static constexpr std::string_view kName = "ql_9";
};

DEFINITE_REFERENCE_FILTER(Ql9);

}  // namespace definite::reference
