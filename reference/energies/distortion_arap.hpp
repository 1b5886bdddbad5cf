#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu |F - R|^2, R the rotation closest to F. p = (mu).
struct Arap {
  using Domain = WithRotation;
  static std::string Name() { return "arap"; }
  static constexpr int kParams = 1;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    return p[0] * (NormSquared(f) - 2 * SumOfStretches(f) + D);
  }
  template <class S, int D, class T>
  static auto Residuals(const Gradient<S, D>& f, const T* p) {
    using std::sqrt;
    const Gradient<S, D> rotation = ClosestRotation(f);
    std::array<S, static_cast<size_t>(D * D)> r;
    for (size_t i = 0; i < r.size(); ++i)
      r[i] = S(sqrt(2 * p[0])) * (f.entries[i] - rotation.entries[i]);
    return r;
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, Arap>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, Arap>);

}  // namespace definite::reference
