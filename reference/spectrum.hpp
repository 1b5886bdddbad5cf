#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reference/matrix.hpp"
#include "reference/quad.hpp"

namespace definite::reference {

// a = vectors diag(values) vectors^T: values (n x 1) ascending, vectors in the columns, in that
// order. Everything is NaN if the matrix was not finite or the solver did not converge.
template <class T>
struct Spectrum {
  Matrix<T> values;
  Matrix<T> vectors;
};

template <class T>
Spectrum<T> UndefinedSpectrum(int n) {
  const T nan = std::numeric_limits<T>::quiet_NaN();
  return {Matrix<T>(n, 1, nan), Matrix<T>(n, n, nan)};
}

template <class T>
bool AllFinite(const Matrix<T>& a) {
  using std::isfinite;
  return std::all_of(a.entries.begin(), a.entries.end(), [](const T& e) { return isfinite(e); });
}

// Cyclic Jacobi (Golub & Van Loan, Matrix Computations, section 8.5), for any scalar. `a` is
// symmetric; only the upper triangle of a finite one is read. An off-diagonal entry counts as zero
// only when it is below the rounding error of both of its diagonal entries, so graded matrices keep
// their small eigenvalues. This ends: a rotation sets its entry to exactly zero, and refills it
// later only by products of other off-diagonal entries, which therefore shrink quadratically even
// in a null space.
template <class T>
Spectrum<T> JacobiSpectrum(Matrix<T> a) {
  using std::abs, std::sqrt;
  const T u = std::numeric_limits<T>::epsilon() / 2;
  const int n = a.rows;
  constexpr int kMaxSweeps = 60;  // 12 x 12 takes 8 to 13 in float128, 25 if graded over 1e+-2000

  if (!AllFinite(a)) return UndefinedSpectrum<T>(n);
  Matrix<T> v(n, n);
  for (int i = 0; i < n; ++i) v(i, i) = T(1);
  const auto at = [&a](int i, int j) -> T& { return i < j ? a(i, j) : a(j, i); };
  const auto rotate = [](T& x, T& y, const T& c, const T& s) {
    const T old_x = x;
    x = c * old_x - s * y;
    y = s * old_x + c * y;
  };

  bool rotated = true;
  for (int sweep = 0; rotated; ++sweep) {
    if (sweep == kMaxSweeps) return UndefinedSpectrum<T>(n);
    rotated = false;
    for (int p = 0; p < n; ++p) {
      for (int q = p + 1; q < n; ++q) {
        const T apq = a(p, q);
        if (abs(apq) <= u * std::min(T(abs(a(p, p))), T(abs(a(q, q))))) continue;
        rotated = true;
        // The smaller root of t^2 + 2 theta t - 1 = 0: an angle of at most 45 degrees.
        const T theta = (a(q, q) - a(p, p)) / (2 * apq);
        const T t = (theta < 0 ? -1 : 1) / (abs(theta) + sqrt(theta * theta + 1));
        const T c = 1 / sqrt(t * t + 1);
        const T s = t * c;
        a(p, p) -= t * apq;
        a(q, q) += t * apq;
        a(p, q) = T(0);
        for (int i = 0; i < n; ++i) {
          if (i != p && i != q) rotate(at(i, p), at(i, q), c, s);
          rotate(v(i, p), v(i, q), c, s);
        }
      }
    }
  }

  Matrix<int> order(n, 1);
  std::iota(order.entries.begin(), order.entries.end(), 0);
  std::sort(order.entries.begin(), order.entries.end(),
            [&a](int i, int j) { return a(i, i) < a(j, j); });
  Spectrum<T> spectrum{Matrix<T>(n, 1), Matrix<T>(n, n)};
  for (int j = 0; j < n; ++j) {
    spectrum.values[j] = a(order[j], order[j]);
    for (int i = 0; i < n; ++i) spectrum.vectors(i, j) = v(i, order[j]);
  }
  return spectrum;
}

// The same by Eigen's SelfAdjointEigenSolver where that converges (in spectrum.cpp, which keeps
// Eigen out of here): a quarter of the time, in float128 too. Errors are relative to |a|.
Spectrum<double> EigenSpectrum(const Matrix<double>& a);
Spectrum<Quad> EigenSpectrum(const Matrix<Quad>& a);

// Its values alone, which take a third of the time.
Matrix<double> EigenvaluesOf(const Matrix<double>& a);

// The solver of choice.
template <class T>
Spectrum<T> SpectrumOf(const Matrix<T>& a) {
  return EigenSpectrum(a);
}

// sum_i f(values[i]) v_i v_i^T, exactly symmetric.
template <class T, class F>
Matrix<T> MapSpectrum(const Spectrum<T>& spectrum, F f) {
  const int n = spectrum.vectors.rows;
  Matrix<T> a(n, n);
  for (int m = 0; m < n; ++m) {
    const T weight = f(spectrum.values[m]);
    for (int i = 0; i < n; ++i) {
      const T wv = weight * spectrum.vectors(i, m);
      for (int j = i; j < n; ++j) a(i, j) += wv * spectrum.vectors(j, m);
    }
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) a(i, j) = a(j, i);
  return a;
}

// What filters make of an eigenvalue. A NaN stays one.
template <class T>
T Clamp(const T& lambda) {
  return lambda < 0 ? T(0) : lambda;
}
template <class T>
T Magnitude(const T& lambda) {
  return lambda < 0 ? T(-lambda) : lambda;
}

// The PSD matrix nearest in the Frobenius norm (Higham 1988): negative eigenvalues become 0, and,
// of a matrix that is known to have at most `positive` others, all but so many of the largest:
// beside exact zeros the rest would be their rounding.
template <class T>
Matrix<T> NearestPsd(const Spectrum<T>& spectrum, int positive) {
  const int n = spectrum.values.rows;
  const T least = positive > 0 ? spectrum.values[std::max(0, n - positive)]
                               : std::numeric_limits<T>::infinity();
  return MapSpectrum(spectrum, [&](const T& l) { return l < 0 || l < least ? T(0) : l; });
}
template <class T>
Matrix<T> NearestPsd(const Spectrum<T>& spectrum) {
  return NearestPsd(spectrum, spectrum.values.rows);
}

}  // namespace definite::reference
