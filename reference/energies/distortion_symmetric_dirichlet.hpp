#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu/2 (|F|^2 + |F^-1|^2) - mu d. p = (mu). Domain: F is not inverted.
struct SymmetricDirichlet {
  using Domain = NotInverted;
  static std::string Name() { return "symmetric_dirichlet"; }
  static constexpr int kParams = 1;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    const S determinant = Determinant(f);
    const S inverse = NormSquared(Cofactors(f)) / (determinant * determinant);
    return p[0] * ((NormSquared(f) + inverse) / T(2) - D);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, SymmetricDirichlet>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, SymmetricDirichlet>);

}  // namespace definite::reference
