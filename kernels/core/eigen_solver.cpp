#include "kernels/core/eigen_solver.hpp"

#include <Eigen/Dense>

#include "kernels/core/jacobi.hpp"

namespace definite {

namespace {

template <int N>
using EigenMatrix = Eigen::Matrix<double, N, N>;

// Our own rotations, which always converge. Reads the lower triangle.
template <int N>
EigenMatrix<N> MapEigenvaluesByJacobi(const EigenMatrix<N>& h, EigenvalueMap map) {
  double a[N][N];
  const double scale =
      h.template triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff();
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) a[i][j] = h(j, i) / scale;  // so that no square overflows
  }
  const EigenSystem<double, N> e = JacobiEigen(a);
  EigenMatrix<N> mapped = EigenMatrix<N>::Zero();
  for (int m = 0; m < N; ++m) {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = e.vectors[i][m];
    mapped += map(scale * e.values[m]) * v * v.transpose();
  }
  return mapped;
}

template <int N>
EigenMatrix<N> MapEigenvaluesOf(const EigenMatrix<N>& h, EigenvalueMap map) {
  const Eigen::SelfAdjointEigenSolver<EigenMatrix<N>> solver(h);  // reads the lower triangle
  // Eigen 3.4 runs out of iterations on a few 12x12 Hessians, three of 1.1 10^8 here: seven of
  // their eigenvalues are zero, and beside zeros on the diagonal it waits for couplings that
  // rounding keeps alive. Which ones they are depends on the instruction set.
  if (solver.info() != Eigen::Success) return MapEigenvaluesByJacobi(h, map);
  const EigenMatrix<N>& v = solver.eigenvectors();
  return v * solver.eigenvalues().unaryExpr(map).asDiagonal() * v.transpose();
}

template <int N>
void Pack(const EigenMatrix<N>& full, double* packed) {
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) *packed++ = full(j, i);
  }
}

}  // namespace

namespace internal {

template <int N>
void MapEigenvalues(const double* h, EigenvalueMap map, double* result) {
  EigenMatrix<N> full;
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) full(j, i) = *h++;
  }
  Pack(MapEigenvaluesOf(full, map), result);
}

template <int F, int D>
void PullBack(const double* lambda, const double* modes, int count, const double* map,
              EigenvalueMap eigenvalues, double* result) {
  EigenMatrix<F> h = EigenMatrix<F>::Zero();
  for (int m = 0; m < count; ++m) {
    const Eigen::Map<const Eigen::Matrix<double, F, 1>> mode(modes + m * F);
    h.noalias() += lambda[m] * mode * mode.transpose();
  }
  if (eigenvalues) h = MapEigenvaluesOf(h, eigenvalues);
  const Eigen::Map<const Eigen::Matrix<double, F, D, Eigen::RowMajor>> s(map);
  Pack(EigenMatrix<D>(s.transpose() * h * s), result);
}

template void MapEigenvalues<6>(const double*, EigenvalueMap, double*);
template void MapEigenvalues<9>(const double*, EigenvalueMap, double*);
template void MapEigenvalues<12>(const double*, EigenvalueMap, double*);
template void PullBack<3, 6>(const double*, const double*, int, const double*, EigenvalueMap,
                             double*);
template void PullBack<6, 9>(const double*, const double*, int, const double*, EigenvalueMap,
                             double*);
template void PullBack<9, 12>(const double*, const double*, int, const double*, EigenvalueMap,
                              double*);

}  // namespace internal
}  // namespace definite
