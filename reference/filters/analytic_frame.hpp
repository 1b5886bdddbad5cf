#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The same matrix by closed-form eigenpairs of the frame Hessian.
struct AnalyticFrame : Analytic {
  static constexpr std::string_view kName = "analytic_frame";
};

DEFINITE_REFERENCE_FILTER(AnalyticFrame);

}  // namespace definite::reference
