#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// The Frobenius-nearest PSD matrix: clamp the eigenvalues of the full Hessian.
struct Numeric {
  static constexpr std::string_view kName = "numeric";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return truth.Nearest();
  }
};

DEFINITE_REFERENCE_FILTER(Numeric);

}  // namespace definite::reference
