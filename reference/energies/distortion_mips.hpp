#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu (|F|^2 / det F - 2), in the plane. p = (mu). Domain: F is not inverted.
struct Mips {
  using Domain = NotInverted;
  static std::string Name() { return "mips"; }
  static constexpr int kParams = 1;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    return p[0] * (NormSquared(f) / Determinant(f) - D);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, Mips>);

}  // namespace definite::reference
