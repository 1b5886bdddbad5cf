#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// The curvature term alone: psi''(s) grad s grad s^T.
struct GaussNewton {
  static constexpr std::string_view kName = "gauss_newton";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return truth.Curvature();
  }
};

DEFINITE_REFERENCE_FILTER(GaussNewton);

}  // namespace definite::reference
