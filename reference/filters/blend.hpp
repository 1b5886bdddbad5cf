#pragma once

#include <string_view>

#include "reference/frame_filter.hpp"

namespace definite::reference {

// (1 - w) times the clamped matrix plus w times the absolute one, in the reduced frame;
// w = kNumerator / kDenominator.
template <int kNumerator, int kDenominator>
struct Blend {
  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    const T w = T(kNumerator) / T(kDenominator);
    return FilterInFrame(truth,
                         [&](const T& lambda) { return lambda < 0 ? T(-w * lambda) : lambda; });
  }
};

struct BlendHalf : Blend<1, 2> {
  static constexpr std::string_view kName = "blend_half";
};

DEFINITE_REFERENCE_FILTER(BlendHalf);

}  // namespace definite::reference
