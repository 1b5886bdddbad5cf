#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// H minus its smallest eigenvalue times the identity, if that eigenvalue is negative.
struct ShiftDiagonal {
  static constexpr std::string_view kName = "shift_diagonal";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    Matrix<T> h = truth.Hessian();
    const T least = truth.HessianSpectrum().values[0];
    if (least < 0)
      for (int i = 0; i < h.rows; ++i) h(i, i) -= least;
    return h;
  }
};

DEFINITE_REFERENCE_FILTER(ShiftDiagonal);

}  // namespace definite::reference
