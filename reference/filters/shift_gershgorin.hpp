#pragma once

#include <cmath>
#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// H plus the multiple of the identity that makes each diagonal entry at least the sum of the other
// magnitudes in its row.
struct ShiftGershgorin {
  static constexpr std::string_view kName = "shift_gershgorin";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    using std::abs;
    Matrix<T> h = truth.Hessian();
    T shift(0);
    for (int i = 0; i < h.rows; ++i) {
      T lacking = -h(i, i);
      for (int j = 0; j < h.cols; ++j)
        if (j != i) lacking += abs(h(i, j));
      if (lacking > shift) shift = lacking;
    }
    for (int i = 0; i < h.rows; ++i) h(i, i) += shift;
    return h;
  }
};

DEFINITE_REFERENCE_FILTER(ShiftGershgorin);

}  // namespace definite::reference
