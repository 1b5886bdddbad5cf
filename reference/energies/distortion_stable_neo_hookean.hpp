#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu/2 (|F|^2 - d) - mu (J - 1) + lambda/2 (J - 1)^2, J = det F (Smith et al. 2018, Eq. 13,
// less its value at rest). p = (mu, lambda).
struct StableNeoHookean {
  using Domain = Everywhere;
  static std::string Name() { return "stable_neo_hookean"; }
  static constexpr int kParams = 2;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    const S change = Determinant(f) - S(1);
    return p[0] * ((NormSquared(f) - D) / T(2) - change) + p[1] * change * change / T(2);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, StableNeoHookean>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, StableNeoHookean>);

}  // namespace definite::reference
