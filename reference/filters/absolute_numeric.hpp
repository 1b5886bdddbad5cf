#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// Absolute values of the eigenvalues of the full Hessian.
struct AbsoluteNumeric {
  static constexpr std::string_view kName = "absolute_numeric";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return MapSpectrum(truth.HessianSpectrum(), Magnitude<T>);
  }
};

DEFINITE_REFERENCE_FILTER(AbsoluteNumeric);

}  // namespace definite::reference
