#pragma once

// Absolute values of the full matrix' eigenvalues, by Eigen. Scalar only.
//
// Source: Chen et al. 2024, Stabler Neo-Hookean Simulation: Absolute Eigenvalue Filtering for
// Projected Newton.

#include <array>
#include <cmath>

#include "kernels/core/eigen.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct AbsoluteNumeric {
  static constexpr std::string_view kName = "absolute_numeric";
  static constexpr std::string_view kSource = "Chen et al. 2024; Eigen SelfAdjointEigenSolver";
  static constexpr std::array<Exemption, 0> kExempt{};

  template <class E, class T>
  requires std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return MapEigenvalues(ToPacked(None::Apply<E>(x, p)),
                          [](double lambda) { return std::abs(lambda); });
  }
};

DEFINITE_FILTER(AbsoluteNumeric);

}  // namespace definite
