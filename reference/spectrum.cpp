#include "reference/spectrum.hpp"

#include <Eigen/Eigenvalues>

namespace definite::reference {

Spectrum<double> EigenSpectrum(const Matrix<double>& a) {
  const int n = a.rows;
  // Eigen 3.4 reports success if the first entry is infinite.
  if (!AllFinite(a)) return UndefinedSpectrum<double>(n);

  // Eigen reads the lower triangle of its column-major view: our row-major upper one.
  const Eigen::Map<const Eigen::MatrixXd> view(a.entries.data(), n, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(view);
  // A few of 10^8 Hessians do not converge.
  if (solver.info() != Eigen::Success) return JacobiSpectrum(a);

  Spectrum<double> spectrum{Matrix<double>(n, 1), Matrix<double>(n, n)};
  for (int j = 0; j < n; ++j) {
    spectrum.values[j] = solver.eigenvalues()[j];
    for (int i = 0; i < n; ++i) spectrum.vectors(i, j) = solver.eigenvectors()(i, j);
  }
  return spectrum;
}

Matrix<double> EigenvaluesOf(const Matrix<double>& a) {
  const int n = a.rows;
  if (!AllFinite(a)) return UndefinedSpectrum<double>(n).values;
  const Eigen::Map<const Eigen::MatrixXd> view(a.entries.data(), n, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(view, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return JacobiSpectrum(a).values;
  Matrix<double> values(n, 1);
  for (int j = 0; j < n; ++j) values[j] = solver.eigenvalues()[j];
  return values;
}

}  // namespace definite::reference
