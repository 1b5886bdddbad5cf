#pragma once

// The clamp of a Hessian's eigenvalues with an eigensolver that lanes share: of the full matrix, in
// the reduced frame, and in the range of the modes. What `numeric` and its kin do, side by side.

#include <tuple>

#include "kernels/core/reduced.hpp"
#include "kernels/core/tridiagonal_ql.hpp"

namespace definite {

struct ByJacobi {
  template <class T, int N>
  static EigenSystem<T, N> Solve(T (&a)[N][N], const T& negligible) {
    return JacobiEigenInRounds(a, negligible);
  }
};
struct ByQl {
  template <class T, int N>
  static EigenSystem<T, N> Solve(T (&a)[N][N], const T& negligible) {
    return QlEigen(a, negligible);
  }
};

template <class Solver, class T, int N>
EigenSystem<T, N> SolveInUnits(const PackedSym<T, N>& h) {
  T largest = T(0x1p-1022);  // the smallest that has an exponent to read
  for (int k = 0; k < h.kSize; ++k) largest = Max(Abs(h.a[k]), largest);
  // In units of a power of two no square overflows, and the norm is at least 2.
  const T scale = InversePowerOfTwo(largest), negligible = T(2.0 * kUnitRoundoff<T>);
  T a[N][N];
  int k = 0;
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) a[i][j] = scale * h.a[k++];
  }
  EigenSystem<T, N> e = Solver::Solve(a, negligible);
  for (int m = 0; m < N; ++m) e.values[m] = e.values[m] / scale;
  return e;
}

// The modes of the positive part of h.
template <class Solver, class T, int N>
Modes<T, N, N> PositivePart(const PackedSym<T, N>& h) {
  const EigenSystem<T, N> e = SolveInUnits<Solver>(h);
  Modes<T, N, N> positive;
  for (int m = 0; m < N; ++m) {
    positive.lambda[m] = Max(T(0.0), e.values[m]);
    for (int i = 0; i < N; ++i) positive.v[m][i] = e.vectors[i][m];
  }
  return positive;
}

// ToPacked, but no entry is -0: a lane that waits for others is turned by angles of zero, which
// change the sign of a zero in its vectors.
template <class T, int D, int K>
PackedSym<T, D> ToPackedWithoutMinusZero(const Modes<T, D, K>& modes) {
  PackedSym<T, D> h;
  int k = 0;
  for (int i = 0; i < D; ++i) {
    T scaled[K];
    for (int m = 0; m < K; ++m) scaled[m] = modes.lambda[m] * modes.v[m][i];
    for (int j = i; j < D; ++j, ++k) {
      T sum = T(0.0);
#pragma GCC unroll 16
      for (int m = 0; m < K; ++m) sum = MulAdd(scaled[m], modes.v[m][j], sum);
      h.a[k] = sum;
    }
  }
  return h;
}

// Of the full matrix.
template <class Solver, class T, int D>
PackedSym<T, D> ClampFull(const PackedSym<T, D>& h) {
  return ToPackedWithoutMinusZero(PositivePart<Solver>(h));
}

// In the frame coordinates, whose map is a few rows over the vertices times the 3x3 identity.
template <class Solver, class T, int F, int D, int K>
PackedSym<T, D> ClampInFrame(const FrameTerm<T, F, D, K>& term) {
  const Modes<T, F, F> in_frame = PositivePart<Solver>(ToPacked(term.modes));
  Modes<T, D, F> modes;
  for (int m = 0; m < F; ++m) {
    modes.lambda[m] = in_frame.lambda[m];
    for (int j = 0; j < D; ++j) {
      T sum = term.map[j % 3][j] * in_frame.v[m][j % 3];
      for (int f = j % 3 + 3; f < F; f += 3) sum = MulAdd(term.map[f][j], in_frame.v[m][f], sum);
      modes.v[m][j] = sum;
    }
  }
  return ToPackedWithoutMinusZero(modes);
}

// In the range of modes that are orthogonal but for the first.
template <class Solver, class T, int D, int K>
PackedSym<T, D> ClampInRange(const Modes<T, D, K>& modes) {
  const Reduced<T, D, K> reduced = Reduce(modes);
  const Modes<T, K, K> small = PositivePart<Solver>(reduced.h);
  Modes<T, D, K> lifted;
  for (int m = 0; m < K; ++m) {
    lifted.lambda[m] = small.lambda[m];
    lifted.v[m] = small.v[m][0] * reduced.basis[0];
    for (int i = 1; i < K; ++i) lifted.v[m] = lifted.v[m] + small.v[m][i] * reduced.basis[i];
  }
  return ToPackedWithoutMinusZero(lifted);
}

}  // namespace definite
