#pragma once

// What the numeric and frame filters ask of Eigen. The library itself stays in eigen_solver.cpp:
// its templates took 20 of the 25 s that one energy's rows took to build.

#include <tuple>

#include "kernels/core/eigen_solver.hpp"
#include "kernels/kernel.hpp"

namespace definite {

inline double ClampToPsd(double lambda) { return lambda < 0 ? 0 : lambda; }  // NaN stays NaN

// sum map(lambda) v v^T over the eigenpairs of h; by Jacobi rotations where Eigen's solver does not
// converge. N: 5, 6, 9, 12.
template <int N>
PackedSym<double, N> MapEigenvalues(const PackedSym<double, N>& h, EigenvalueMap map) {
  PackedSym<double, N> result;
  internal::MapEigenvalues<N>(h.a, map, result.a);
  return result;
}

// h minus its negative eigenpairs. N: 12.
template <int N>
PackedSym<double, N> DropNegative(const PackedSym<double, N>& h) {
  PackedSym<double, N> result;
  internal::DropNegative<N>(h.a, result.a);
  return result;
}

// The clamp of h rounded to float. N: 12.
template <int N>
PackedSym<double, N> ClampInFloat(const PackedSym<double, N>& h) {
  PackedSym<double, N> result;
  internal::ClampInFloat<N>(h.a, result.a);
  return result;
}

// What blocks over principal stretches give, clamped each and pulled back: `scaling` over the
// u_i v_i^T, and for each pair j < k, in their order, [[a, b], [b, a]] over u_j v_k^T and u_k
// v_j^T.
template <int D, int P>
PackedSym<double, D*(D + 1)> ClampStretchBlocks(const Vec<double, D> (&u)[D],
                                                const Vec<double, D> (&v)[D],
                                                const PackedSym<double, D>& scaling,
                                                const Vec<double, 2> (&pairs)[P],
                                                const double (&map)[D * D][D * (D + 1)]) {
  PackedSym<double, D*(D + 1)> result;
  internal::ClampStretchBlocks<D>(u->v, v->v, scaling.a, pairs->v, map[0], result.a);
  return result;
}

// map^T (sum_m lambda[m] v[m] v[m]^T) map, one outer product after the other and then the products
// of the reduced frame, as one writes them in Eigen. Where `eigenvalues` is given, the eigenvalues
// of the sum are mapped first. F x D: 3 x 6, 4 x 6, 6 x 9,
// 9 x 12.
template <int F, int D>
PackedSym<double, D> PullBackInEigen(const double* lambda, const Vec<double, F>* v, int count,
                                     const double (&map)[F][D], EigenvalueMap eigenvalues) {
  static_assert(sizeof(Vec<double, F>) == F * sizeof(double));
  PackedSym<double, D> result;
  internal::PullBack<F, D>(lambda, v->v, count, map[0], eigenvalues, result.a);
  return result;
}

// The same of an energy's frame terms, added up, with weights(lambda) for each lambda.
template <class E, class Weights>
PackedSym<double, E::kDofs> FilterInFrame(const Vec<double, E::kDofs>& x,
                                          const Vec<double, E::kParams>& p, Weights weights,
                                          EigenvalueMap eigenvalues = nullptr) {
  PackedSym<double, E::kDofs> sum{};
  const auto add = [&](auto& term) {
    auto& modes = term.modes;
    MapWeights(modes, weights);
    const auto part = PullBackInEigen(modes.lambda, modes.v, modes.kCount, term.map, eigenvalues);
    for (int k = 0; k < part.kSize; ++k) sum.a[k] += part.a[k];
  };
  auto terms = E::FrameTerms(x, p);
  std::apply([&](auto&... term) { (add(term), ...); }, terms);
  return sum;
}

}  // namespace definite
