#include "kernels/core/eigen_solver.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "kernels/core/eigen.hpp"
#include "kernels/core/jacobi.hpp"
#include "kernels/core/precision.hpp"

namespace definite {

namespace {

template <int N>
using EigenMatrix = Eigen::Matrix<double, N, N>;

template <int N>
struct Eigenpairs {
  Eigen::Matrix<double, N, 1> values;
  EigenMatrix<N> vectors;  // in the columns
};

// Our own rotations, which always converge. Reads the lower triangle.
template <int N>
Eigenpairs<N> SolveByJacobi(const EigenMatrix<N>& h) {
  double a[N][N];
  const double scale =
      h.template triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff();
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) a[i][j] = h(j, i) / scale;  // so that no square overflows
  }
  const EigenSystem<double, N> e = JacobiEigen(a);
  Eigenpairs<N> pairs;
  for (int m = 0; m < N; ++m) {
    pairs.values[m] = scale * e.values[m];
    for (int i = 0; i < N; ++i) pairs.vectors(i, m) = e.vectors[i][m];
  }
  return pairs;
}

// Reads the lower triangle.
template <int N>
Eigenpairs<N> Solve(const EigenMatrix<N>& h) {
  const Eigen::SelfAdjointEigenSolver<EigenMatrix<N>> solver(h);
  // Eigen 3.4 runs out of iterations on a few 12x12 Hessians, three of 1.1 10^8 here: seven of
  // their eigenvalues are zero, and beside zeros on the diagonal it waits for couplings that
  // rounding keeps alive. Which ones they are depends on the instruction set.
  if (solver.info() != Eigen::Success) return SolveByJacobi(h);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int N>
EigenMatrix<N> MapEigenvaluesOf(const EigenMatrix<N>& h, EigenvalueMap map) {
  const auto [values, v] = Solve(h);
  return v * values.unaryExpr(map).asDiagonal() * v.transpose();
}

template <int N>
EigenMatrix<N> Unpack(const double* packed) {
  EigenMatrix<N> full;
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) full(j, i) = *packed++;
  }
  return full;
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
  Pack(MapEigenvaluesOf(Unpack<N>(h), map), result);
}

template <int N>
void DropNegative(const double* h, double* result) {
  EigenMatrix<N> full = Unpack<N>(h);
  const auto [values, v] = Solve(full);
  // Seven eigenvalues are zero, and half of them a rounding error below it.
  const double negligible = kUnitRoundoff<double> * values.cwiseAbs().maxCoeff();
  for (int m = 0; m < N; ++m) {
    if (values[m] < -negligible) full.noalias() -= values[m] * v.col(m) * v.col(m).transpose();
  }
  Pack(full, result);
}

template <int N>
void ClampInFloat(const double* h, double* result) {
  using Single = Eigen::Matrix<float, N, N>;
  const EigenMatrix<N> full = Unpack<N>(h);
  double largest = 0;  // floats have less range: the matrix goes in units of its largest entry
  for (int k = 0; k < N * (N + 1) / 2; ++k) largest = std::max(largest, std::abs(h[k]));
  const double scale = largest > 0 ? largest : 1;
  const Eigen::SelfAdjointEigenSolver<Single> solver(Single((full / scale).template cast<float>()));
  if (solver.info() != Eigen::Success) return MapEigenvalues<N>(h, ClampToPsd, result);
  const Single& v = solver.eigenvectors();
  const Single clamped = v * solver.eigenvalues().cwiseMax(0).asDiagonal() * v.transpose();
  Pack(EigenMatrix<N>(scale * clamped.template cast<double>()), result);
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

template <int D>
void ClampStretchBlocks(const double* u, const double* v, const double* scaling,
                        const double* pairs, const double* map, double* result) {
  constexpr int kF = D * D;
  // Over the u_a v_b^T, the last index of a and b first.
  EigenMatrix<kF> h = EigenMatrix<kF>::Zero();
  const EigenMatrix<D> stretches = MapEigenvaluesOf(Unpack<D>(scaling), ClampToPsd);
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j <= i; ++j) h(i * (D + 1), j * (D + 1)) = stretches(i, j);
  }
  for (int j = 0; j < D; ++j) {
    for (int k = j + 1; k < D; ++k, pairs += 2) {
      EigenMatrix<2> block;
      block << pairs[0], pairs[1], pairs[1], pairs[0];
      block = MapEigenvaluesOf(block, ClampToPsd);
      const int first = k * D + j, second = j * D + k;
      h(first, first) = block(0, 0);
      h(second, second) = block(1, 1);
      h(first, second) = h(second, first) = block(1, 0);
    }
  }
  h = EigenMatrix<kF>(h.template selfadjointView<Eigen::Lower>());
  const Eigen::Map<const EigenMatrix<D>> left(u), right(v);
  EigenMatrix<kF> basis;  // the u_a v_b^T, column by column
  for (int b = 0; b < D; ++b) {
    for (int a = 0; a < D; ++a) {
      for (int j = 0; j < D; ++j) {
        basis.template block<D, 1>(j * D, b * D + a) = right(j, b) * left.col(a);
      }
    }
  }
  const Eigen::Map<const Eigen::Matrix<double, kF, kF + D, Eigen::RowMajor>> s(map);
  Pack(EigenMatrix<kF + D>(s.transpose() * (basis * h * basis.transpose()) * s), result);
}

template void DropNegative<12>(const double*, double*);
template void ClampInFloat<12>(const double*, double*);
template void MapEigenvalues<5>(const double*, EigenvalueMap, double*);
template void MapEigenvalues<6>(const double*, EigenvalueMap, double*);
template void MapEigenvalues<9>(const double*, EigenvalueMap, double*);
template void MapEigenvalues<12>(const double*, EigenvalueMap, double*);
template void PullBack<3, 6>(const double*, const double*, int, const double*, EigenvalueMap,
                             double*);
template void PullBack<4, 6>(const double*, const double*, int, const double*, EigenvalueMap,
                             double*);
template void PullBack<6, 9>(const double*, const double*, int, const double*, EigenvalueMap,
                             double*);
template void PullBack<9, 12>(const double*, const double*, int, const double*, EigenvalueMap,
                              double*);
template void ClampStretchBlocks<2>(const double*, const double*, const double*, const double*,
                                    const double*, double*);
template void ClampStretchBlocks<3>(const double*, const double*, const double*, const double*,
                                    const double*, double*);

}  // namespace internal
}  // namespace definite
