#pragma once

#include <string_view>

#include "reference/frame_filter.hpp"

namespace definite::reference {

// Absolute values instead of clamping, in the reduced frame.
struct Absolute {
  static constexpr std::string_view kName = "absolute";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    return FilterInFrame(truth, Magnitude<T>);
  }
};

DEFINITE_REFERENCE_FILTER(Absolute);

}  // namespace definite::reference
