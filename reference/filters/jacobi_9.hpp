#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The same matrix by Jacobi rotations in the frame.
struct Jacobi9 : Analytic {
  static constexpr std::string_view kName = "jacobi_9";
};

DEFINITE_REFERENCE_FILTER(Jacobi9);

}  // namespace definite::reference
