#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The same matrix by a numerical eigensolver in the frame.
struct NumericFrame : Analytic {
  static constexpr std::string_view kName = "numeric_frame";
};

DEFINITE_REFERENCE_FILTER(NumericFrame);

}  // namespace definite::reference
