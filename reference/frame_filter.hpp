#pragma once

#include "reference/filter.hpp"

namespace definite::reference {

// Maps by f the eigenvalues of each of the terms that make up the Hessian, S^T Hc S and
// D^T (-Hc) D.
template <class T, class F>
Matrix<T> FilterInFrame(Truth<T>& truth, F f) {
  const Spectrum<T>& spectrum = truth.FrameSpectrum();
  const Matrix<T> main = Congruence(MapSpectrum(spectrum, f), truth.FrameMap());
  const Matrix<T>& remainder = truth.FrameRemainder();
  if (remainder.entries.empty()) return main;
  const auto f_of_opposite = [&f](const T& lambda) { return f(-lambda); };
  return main + Congruence(MapSpectrum(spectrum, f_of_opposite), remainder);
}

}  // namespace definite::reference
