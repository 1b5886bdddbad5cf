#pragma once

// Eigendecompositions by Eigen, for the numeric filters.

#include <Eigen/Dense>
#include <limits>
#include <tuple>

#include "kernels/kernel.hpp"

namespace definite {

template <int N>
using EigenMatrix = Eigen::Matrix<double, N, N>;

// sum map(lambda) v v^T; NaN where the solver does not converge. Reads the lower triangle.
template <int N, class Map>
EigenMatrix<N> MapEigenvalues(const EigenMatrix<N>& h, Map map) {
  const Eigen::SelfAdjointEigenSolver<EigenMatrix<N>> solver(h);
  if (solver.info() != Eigen::Success) {
    return EigenMatrix<N>::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const EigenMatrix<N>& v = solver.eigenvectors();
  return v * solver.eigenvalues().unaryExpr(map).asDiagonal() * v.transpose();
}

template <int N>
EigenMatrix<N> ToEigen(const PackedSym<double, N>& h) {
  EigenMatrix<N> full;
  for (int i = 0, at = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) full(j, i) = h.a[at++];
  }
  return full;
}

template <int N>
PackedSym<double, N> FromEigen(const EigenMatrix<N>& full) {
  PackedSym<double, N> h;
  for (int i = 0, at = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) h.a[at++] = full(j, i);
  }
  return h;
}

// sum map(lambda) v v^T of modes, one outer product after the other.
template <int N, int K, class Map>
EigenMatrix<N> SumInEigen(const Modes<double, N, K>& modes, Map map) {
  EigenMatrix<N> h = EigenMatrix<N>::Zero();
  for (int m = 0; m < K; ++m) {
    const Eigen::Map<const Eigen::Matrix<double, N, 1>> v(modes.v[m].v);
    h.noalias() += map(modes.lambda[m]) * v * v.transpose();
  }
  return h;
}

// map^T h map of one term: the products of the reduced frame as one writes them in Eigen.
template <int F, int D, int K>
EigenMatrix<D> PullBackInEigen(const FrameTerm<double, F, D, K>& term, const EigenMatrix<F>& h) {
  const Eigen::Map<const Eigen::Matrix<double, F, D, Eigen::RowMajor>> map(&term.map[0][0]);
  return map.transpose() * h * map;
}

// The sum over an energy's frame terms of map^T reduce(modes) map, packed.
template <class E, class Reduce>
PackedSym<double, E::kDofs> FilterInFrame(const Vec<double, E::kDofs>& x,
                                          const Vec<double, E::kParams>& p, Reduce reduce) {
  const auto sum = [&](const auto&... term) -> EigenMatrix<E::kDofs> {
    return (PullBackInEigen(term, reduce(term.modes)) + ...);
  };
  return FromEigen(EigenMatrix<E::kDofs>(std::apply(sum, E::FrameTerms(x, p))));
}

inline double ClampToPsd(double lambda) { return lambda < 0 ? 0 : lambda; }  // NaN stays NaN

}  // namespace definite
