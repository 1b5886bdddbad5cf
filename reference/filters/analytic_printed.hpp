#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The paper's printed formulas mean the same matrix as the stable ones.
struct AnalyticPrinted : Analytic {
  static constexpr std::string_view kName = "analytic_printed";
};

DEFINITE_REFERENCE_FILTER(AnalyticPrinted);

}  // namespace definite::reference
