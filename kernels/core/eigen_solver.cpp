#include "kernels/core/eigen_solver.hpp"

#include <Eigen/Dense>
#include <limits>

namespace definite {

namespace {

template <int N>
using EigenMatrix = Eigen::Matrix<double, N, N>;

template <int N>
EigenMatrix<N> MapEigenvaluesOf(const EigenMatrix<N>& h, EigenvalueMap map) {
  Eigen::SelfAdjointEigenSolver<EigenMatrix<N>> solver(h);  // reads the lower triangle
  double shift = 0;
  if (solver.info() != Eigen::Success) {
    // Eigen 3.4 runs out of iterations on one of 5 10^7 12x12 Hessians (`paper`, AVX-512): seven of
    // their eigenvalues are zero, and beside zeros on the diagonal it waits for couplings that
    // rounding keeps alive. It takes the same matrix with all eigenvalues moved away from zero.
    shift = h.norm();
    solver.compute(h + shift * EigenMatrix<N>::Identity());
    if (solver.info() != Eigen::Success) {
      return EigenMatrix<N>::Constant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  const EigenMatrix<N>& v = solver.eigenvectors();
  return v * (solver.eigenvalues().array() - shift).unaryExpr(map).matrix().asDiagonal() *
         v.transpose();
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
