#pragma once

#include "reference/filter.hpp"

namespace definite::reference {

// Maps by f the eigenvalues of each of the terms that sum to the Hessian.
template <class T, class F>
Matrix<T> FilterInFrame(Truth<T>& truth, F f) {
  Matrix<T> sum(truth.Of().dofs, truth.Of().dofs);
  for (size_t i = 0; i < truth.FrameTerms().size(); ++i)
    sum = sum + Congruence(MapSpectrum(truth.FrameSpectra()[i], f), truth.FrameTerms()[i].map);
  return sum;
}

}  // namespace definite::reference
