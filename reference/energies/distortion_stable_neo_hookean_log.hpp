#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu/2 (|F|^2 - d) - mu g (J - 1) + lambda/2 (J - 1)^2 - mu/2 log((|F|^2 + 1)/(d + 1)),
// J = det F and g = d/(d + 1) (Smith et al. 2018, Eq. 14, less its value at rest). p = (mu,
// lambda).
struct StableNeoHookeanLog {
  using Domain = Everywhere;
  static std::string Name() { return "stable_neo_hookean_log"; }
  static constexpr int kParams = 2;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    using std::log;
    const S change = Determinant(f) - S(1), square = NormSquared(f);
    const T g = T(D) / T(D + 1);
    return p[0] * ((square - D) / T(2) - g * change - log((square + 1) / T(D + 1)) / T(2)) +
           p[1] * change * change / T(2);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, StableNeoHookeanLog>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, StableNeoHookeanLog>);

}  // namespace definite::reference
