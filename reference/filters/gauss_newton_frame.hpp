#pragma once

#include <string_view>

#include "reference/filters/gauss_newton.hpp"

namespace definite::reference {

// The same matrix through the frame.
struct GaussNewtonFrame : GaussNewton {
  static constexpr std::string_view kName = "gauss_newton_frame";
};

DEFINITE_REFERENCE_FILTER(GaussNewtonFrame);

}  // namespace definite::reference
