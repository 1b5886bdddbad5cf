#include "reference/spectrum.hpp"

#include <Eigen/Core>

namespace Eigen {

// Boost's own has no infinity, which Eigen's norms ask for.
template <>
struct NumTraits<definite::reference::Quad> : GenericNumTraits<definite::reference::Quad> {
  static int digits10() { return 33; }
  static definite::reference::Quad dummy_precision() { return 1e-30; }
};

}  // namespace Eigen

#include <Eigen/Eigenvalues>

namespace definite::reference {

namespace {

template <class T>
using Dense = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

// Eigen reads the lower triangle of its column-major view: our row-major upper one.
template <class T>
Eigen::Map<const Dense<T>> ViewOf(const Matrix<T>& a) {
  return {a.entries.data(), a.rows, a.rows};
}

template <class T>
Spectrum<T> Solve(const Matrix<T>& a) {
  const int n = a.rows;
  // Eigen 3.4 reports success if the first entry is infinite.
  if (!AllFinite(a)) return UndefinedSpectrum<T>(n);
  const Eigen::SelfAdjointEigenSolver<Dense<T>> solver(ViewOf(a));
  // A few of 10^8 Hessians do not converge.
  if (solver.info() != Eigen::Success) return JacobiSpectrum(a);

  Spectrum<T> spectrum{Matrix<T>(n, 1), Matrix<T>(n, n)};
  for (int j = 0; j < n; ++j) {
    spectrum.values[j] = solver.eigenvalues()[j];
    for (int i = 0; i < n; ++i) spectrum.vectors(i, j) = solver.eigenvectors()(i, j);
  }
  return spectrum;
}

}  // namespace

Spectrum<double> EigenSpectrum(const Matrix<double>& a) { return Solve(a); }
Spectrum<Quad> EigenSpectrum(const Matrix<Quad>& a) { return Solve(a); }

Matrix<double> EigenvaluesOf(const Matrix<double>& a) {
  const int n = a.rows;
  if (!AllFinite(a)) return UndefinedSpectrum<double>(n).values;
  const Eigen::SelfAdjointEigenSolver<Dense<double>> solver(ViewOf(a), Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return JacobiSpectrum(a).values;
  Matrix<double> values(n, 1);
  for (int j = 0; j < n; ++j) values[j] = solver.eigenvalues()[j];
  return values;
}

}  // namespace definite::reference
