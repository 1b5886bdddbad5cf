#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu/2 (|F|^2 - d) - mu L + lambda/2 L^2, L = log det F. p = (mu, lambda). Domain: F is not
// inverted.
struct NeoHookean {
  using Domain = NotInverted;
  static std::string Name() { return "neo_hookean"; }
  static constexpr int kParams = 2;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    using std::log;
    const S volume = log(Determinant(f));
    return p[0] * ((NormSquared(f) - D) / T(2) - volume) + p[1] * volume * volume / T(2);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, NeoHookean>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, NeoHookean>);

}  // namespace definite::reference
