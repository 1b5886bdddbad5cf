#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// The exact Hessian, unfiltered.
struct None {
  static constexpr std::string_view kName = "none";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return truth.Hessian();
  }
};

DEFINITE_REFERENCE_FILTER(None);

}  // namespace definite::reference
