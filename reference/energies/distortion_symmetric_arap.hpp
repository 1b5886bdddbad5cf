#pragma once

#include "reference/distortion.hpp"

namespace definite::reference {

// psi = mu/2 (|F - R|^2 + |F^-1 - R^-1|^2), R the rotation closest to F. p = (mu). Domain: F is not
// inverted.
struct SymmetricArap {
  using Domain = NotInverted;
  static std::string Name() { return "symmetric_arap"; }
  static constexpr int kParams = 1;

  template <class S, int D, class T>
  static S Value(const Gradient<S, D>& f, const T* p) {
    // The stretches of F^-1 sum to x / det F in the plane; in space to s1 s2 + s1 s3 + s2 s3 of it.
    const S determinant = Determinant(f), square = NormSquared(f), sum = SumOfStretches(f);
    const S inverse = NormSquared(Cofactors(f)) / (determinant * determinant);
    const S inverse_sum = (D == 2 ? sum : (sum * sum - square) / T(2)) / determinant;
    return p[0] / T(2) * (square - 2 * sum + D + inverse - 2 * inverse_sum + D);
  }
};

DEFINITE_REFERENCE_ENERGY(Distortion<Triangle, SymmetricArap>);
DEFINITE_REFERENCE_ENERGY(Distortion<Tetrahedron, SymmetricArap>);

}  // namespace definite::reference
