#pragma once

// Eigendecomposition of the full matrix, clamp, rebuild: the paper's baseline. Scalar only.

#include <Eigen/Dense>
#include <limits>

#include "kernels/filters/none.hpp"

namespace definite {

struct Numeric {
  static constexpr std::string_view kName = "numeric";
  static constexpr std::string_view kSource = "Eigen SelfAdjointEigenSolver, clamp, rebuild";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
      {Property::kPsd, "the same error leaves eigenvalues of about -u |H|"},
  };

  template <class E, class T>
    requires std::same_as<T, double>
  static PackedSym<T, E::kDofs> Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    constexpr int kD = E::kDofs;
    PackedSym<double, kD> h = ToPacked(None::Apply<E>(x, p));
    Eigen::Matrix<double, kD, kD> full;
    for (int i = 0, at = 0; i < kD; ++i) {
      for (int j = i; j < kD; ++j) full(j, i) = h.a[at++];  // the solver reads the lower triangle
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kD, kD>> solver(full);
    if (solver.info() != Eigen::Success) {
      for (double& a : h.a) a = std::numeric_limits<double>::quiet_NaN();
      return h;
    }
    const auto& v = solver.eigenvectors();
    full.noalias() = v * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * v.transpose();
    for (int i = 0, at = 0; i < kD; ++i) {
      for (int j = i; j < kD; ++j) h.a[at++] = full(i, j);
    }
    return h;
  }
};

DEFINITE_FILTER(Numeric);

}  // namespace definite
