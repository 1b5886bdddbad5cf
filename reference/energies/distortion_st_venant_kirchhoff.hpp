#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu |E|^2 + k/2 tr(E)^2, E = (F^T F - I)/2. p = (mu, k).
struct StVenantKirchhoff {
  using Domain = Everywhere;
  static std::string Name() { return "st_venant_kirchhoff"; }
  static constexpr int kParams = 2;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    const Gradient<S, D> strain = Strain(f);
    const S trace = Trace(strain);
    return p[0] * NormSquared(strain) + p[1] * trace * trace / T(2);
  }
  template <class S, int D, class T>
  static auto Residuals(const Gradient<S, D>& f, const T* p) {
    using std::sqrt;
    const Gradient<S, D> strain = Strain(f);
    std::array<S, static_cast<size_t>(D * D + 1)> r;
    for (size_t i = 0; i < D * D; ++i) r[i] = S(sqrt(2 * p[0])) * strain.entries[i];
    r.back() = S(sqrt(p[1])) * Trace(strain);
    return r;
  }

 private:
  template <class S, int D>
  static Gradient<S, D> Strain(const Gradient<S, D>& f) {
    Gradient<S, D> e = RightCauchyGreen(f);
    for (int i = 0; i < D; ++i) e(i, i) = e(i, i) - S(1);
    for (S& entry : e.entries) entry = entry / S(2);
    return e;
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, StVenantKirchhoff>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, StVenantKirchhoff>);

}  // namespace definite::reference
