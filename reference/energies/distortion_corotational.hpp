#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu |F - R|^2 + k/2 tr(R^T F - I)^2, R the rotation closest to F. p = (mu, k).
struct Corotational {
  using Domain = WithRotation;
  static std::string Name() { return "corotational"; }
  static constexpr int kParams = 2;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    const S sum = SumOfStretches(f), strain = sum - D;
    return p[0] * (NormSquared(f) - 2 * sum + D) + p[1] * strain * strain / T(2);
  }
  template <class S, int D, class T>
  static auto Residuals(const Gradient<S, D>& f, const T* p) {
    using std::sqrt;
    const Gradient<S, D> rotation = ClosestRotation(f);
    std::array<S, static_cast<size_t>(D * D + 1)> r;
    for (size_t i = 0; i < D * D; ++i)
      r[i] = S(sqrt(2 * p[0])) * (f.entries[i] - rotation.entries[i]);
    r.back() = S(sqrt(p[1])) * (SumOfStretches(f) - D);
    return r;
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, Corotational>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, Corotational>);

}  // namespace definite::reference
