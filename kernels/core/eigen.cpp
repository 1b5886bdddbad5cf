#include "kernels/core/eigen.hpp"

#include <Eigen/Dense>
#include <limits>

namespace definite {

namespace {

template <int N>
using EigenMatrix = Eigen::Matrix<double, N, N>;

template <int N>
EigenMatrix<N> MapEigenvaluesOf(const EigenMatrix<N>& h, EigenvalueMap map) {
  const Eigen::SelfAdjointEigenSolver<EigenMatrix<N>> solver(h);  // reads the lower triangle
  if (solver.info() != Eigen::Success) {
    return EigenMatrix<N>::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const EigenMatrix<N>& v = solver.eigenvectors();
  return v * solver.eigenvalues().unaryExpr(map).asDiagonal() * v.transpose();
}

template <int N>
PackedSym<double, N> FromEigen(const EigenMatrix<N>& full) {
  PackedSym<double, N> h;
  for (int i = 0, at = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) h.a[at++] = full(j, i);
  }
  return h;
}

}  // namespace

template <int N>
PackedSym<double, N> MapEigenvalues(const PackedSym<double, N>& h, EigenvalueMap map) {
  EigenMatrix<N> full;
  for (int i = 0, at = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) full(j, i) = h.a[at++];
  }
  return FromEigen(MapEigenvaluesOf(full, map));
}

template <int F, int D>
PackedSym<double, D> PullBackInEigen(const double* lambda, const Vec<double, F>* v, int count,
                                     const double (&map)[F][D], EigenvalueMap eigenvalues) {
  EigenMatrix<F> h = EigenMatrix<F>::Zero();
  for (int m = 0; m < count; ++m) {
    const Eigen::Map<const Eigen::Matrix<double, F, 1>> mode(v[m].v);
    h.noalias() += lambda[m] * mode * mode.transpose();
  }
  if (eigenvalues) h = MapEigenvaluesOf(h, eigenvalues);
  const Eigen::Map<const Eigen::Matrix<double, F, D, Eigen::RowMajor>> s(&map[0][0]);
  return FromEigen(EigenMatrix<D>(s.transpose() * h * s));
}

template PackedSym<double, 6> MapEigenvalues(const PackedSym<double, 6>&, EigenvalueMap);
template PackedSym<double, 9> MapEigenvalues(const PackedSym<double, 9>&, EigenvalueMap);
template PackedSym<double, 12> MapEigenvalues(const PackedSym<double, 12>&, EigenvalueMap);
template PackedSym<double, 12> PullBackInEigen(const double*, const Vec<double, 9>*, int,
                                               const double (&)[9][12], EigenvalueMap);

}  // namespace definite
