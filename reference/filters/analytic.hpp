#pragma once

#include <string_view>

#include "reference/frame_filter.hpp"

namespace definite::reference {

// Clamp in the reduced frame, then pull back (Shi & Kim 2023, section 4; with a remainder, Eq. 17).
struct Analytic {
  static constexpr std::string_view kName = "analytic";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return FilterInFrame(truth, Clamp<T>);
  }
};

DEFINITE_REFERENCE_FILTER(Analytic);

}  // namespace definite::reference
