#pragma once

// A Cholesky factorisation first: H itself if it is PSD already, else `numeric`. It never helps for
// a signed penalty, whose Hessian has two negative eigenvalues wherever it acts
// (docs/derivations.md, section 2, inertia). Scalar only.

#include <algorithm>
#include <limits>

#include "kernels/core/eigen.hpp"
#include "kernels/core/precision.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericProbed {
  static constexpr std::string_view kName = "numeric_probed";
  static constexpr std::string_view kSource =
      "Cholesky, then Eigen SelfAdjointEigenSolver, clamp, rebuild";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
      {Property::kPsd, "the same error leaves eigenvalues of about -u |H|"},
  };

  template <class E, class T>
  requires kStudied<E> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    const PackedSym<T, E::kDofs> h = ToPacked(None::Apply<E>(x, p));
    return IsPsd(h) ? h : MapEigenvalues(h, ClampToPsd);
  }

 private:
  // Whether the pivots of h, lifted by a rounding error of the largest possible ones, are positive.
  // An indefinite matrix shows at one of the first.
  template <int N>
  static bool IsPsd(const PackedSym<double, N>& h) {
    double a[N][N], largest = 0;
    int k = 0;
    for (int i = 0; i < N; ++i) {
      for (int j = i; j < N; ++j) a[i][j] = h.a[k++];
      largest = std::max(largest, a[i][i]);
    }
    const double lift = N * kUnitRoundoff<double> * largest + std::numeric_limits<double>::min();
    for (int i = 0; i < N; ++i) {
      const double pivot = a[i][i] + lift;
      if (!(pivot > 0)) return false;
      for (int r = i + 1; r < N; ++r) {
        const double factor = a[i][r] / pivot;
        for (int c = r; c < N; ++c) a[r][c] -= factor * a[i][c];
      }
    }
    return true;
  }
};

DEFINITE_FILTER(NumericProbed);

}  // namespace definite
