#pragma once

#include <string_view>

#include "reference/filter.hpp"
#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The paper's printed formulas mean the same matrix as the stable ones.
struct AnalyticPrinted {
  static constexpr std::string_view kName = "analytic_printed";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return Analytic::Define(truth);
  }
};

DEFINITE_REFERENCE_FILTER(AnalyticPrinted);

}  // namespace definite::reference
