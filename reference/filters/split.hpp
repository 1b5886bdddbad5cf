#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// Clamps the geometric term psi' Hess s in x and adds the curvature, whose psi'' is never negative.
struct Split {
  static constexpr std::string_view kName = "split";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return NearestPsd(SpectrumOf(truth.Hessian() - truth.Curvature())) + truth.Curvature();
  }
};

DEFINITE_REFERENCE_FILTER(Split);

}  // namespace definite::reference
