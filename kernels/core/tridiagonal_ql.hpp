#pragma once

// Eigensystems of symmetric matrices by Householder reflections to tridiagonal form and implicit QL
// iterations on it, in a shape that lanes share: each lane takes the steps that it would take
// alone.
//
// Source: Golub & Van Loan, Matrix Computations, sections 8.3.1 and 8.3.5.
// Differs: a coupling counts as zero below the rounding error of the whole matrix, not of its two
// neighbours on the diagonal. A contact Hessian has seven eigenvalues of zero, which Householder's
// reduction leaves as a block of rounding errors: its eigenvalues are as good as any.

#include "kernels/core/jacobi.hpp"
#include "kernels/core/precision.hpp"

namespace definite {

// diagonal[i], and coupling[i] between i and i + 1; the last one is zero.
template <class T, int N>
struct Tridiagonal {
  T diagonal[N], coupling[N];
};

// a = q t q^T. Reads the upper triangle, and leaves the reflections in it.
template <class T, int N>
Tridiagonal<T, N> Tridiagonalise(T (&a)[N][N], T (&q)[N][N]) {
  Tridiagonal<T, N> t;
  T weight[N];  // reflection k is I - weight[k] v v^T, v in row k right of the diagonal
  for (int k = 0; k < N - 2; ++k) {
    T* const v = a[k];
    T square = v[k + 1] * v[k + 1];
    for (int i = k + 2; i < N; ++i) square = MulAdd(v[i], v[i], square);
    const T norm = Sqrt(square);
    // Away from the first entry, so that nothing cancels.
    const T image = Select(v[k + 1] > T(0.0), -norm, norm);
    const T half = MulAdd(norm, Abs(v[k + 1]), square);  // |v|^2 / 2
    const auto null = half <= T(0.0);
    weight[k] = Select(null, T(0.0), T(1.0)) / Select(null, T(1.0), half);
    t.diagonal[k] = v[k];
    t.coupling[k] = image;
    v[k + 1] = v[k + 1] - image;

    T w[N];
    for (int i = k + 1; i < N; ++i) w[i] = T(0.0);
    for (int i = k + 1; i < N; ++i) {
      T sum = MulAdd(a[i][i], v[i], w[i]);
      for (int j = i + 1; j < N; ++j) {
        sum = MulAdd(a[i][j], v[j], sum);
        w[j] = MulAdd(a[i][j], v[i], w[j]);
      }
      w[i] = weight[k] * sum;
    }
    T along = w[k + 1] * v[k + 1];
    for (int i = k + 2; i < N; ++i) along = MulAdd(w[i], v[i], along);
    along = T(-0.5) * weight[k] * along;
    for (int i = k + 1; i < N; ++i) w[i] = MulAdd(along, v[i], w[i]);
    for (int i = k + 1; i < N; ++i) {
      for (int j = i; j < N; ++j) a[i][j] = a[i][j] - MulAdd(v[i], w[j], w[i] * v[j]);
    }
  }
  t.diagonal[N - 2] = a[N - 2][N - 2];
  t.coupling[N - 2] = a[N - 2][N - 1];
  t.diagonal[N - 1] = a[N - 1][N - 1];
  t.coupling[N - 1] = T(0.0);

  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) q[i][j] = T(i == j ? 1.0 : 0.0);
  }
  // The last reflection first: each then meets only what lies right of and below its own row.
  for (int k = N - 3; k >= 0; --k) {
    const T* const v = a[k];
    T sum[N];
    for (int j = k + 1; j < N; ++j) sum[j] = T(0.0);
    for (int i = k + 1; i < N; ++i) {
      for (int j = k + 1; j < N; ++j) sum[j] = MulAdd(v[i], q[i][j], sum[j]);
    }
    for (int i = k + 1; i < N; ++i) {
      const T weighted = -(weight[k] * v[i]);
      for (int j = k + 1; j < N; ++j) q[i][j] = MulAdd(weighted, sum[j], q[i][j]);
    }
  }
  return t;
}

// One QL step with Wilkinson's shift on rows `first` to `end` of t, where end > first; other lanes
// keep what they have. `end` is a row's number.
template <class T, int N>
void QlStep(int first, const T& end, Tridiagonal<T, N>& t, T (&q)[N][N]) {
  T(&d)[N] = t.diagonal;
  T(&e)[N] = t.coupling;
  // The eigenvalue of the first two rows that is nearer to the first.
  const T half = T(0.5) * (d[first + 1] - d[first]);
  const T root = Sqrt(MulAdd(half, half, e[first] * e[first]));
  const T larger = Select(half < T(0.0), half - root, half + root);
  const auto none = Abs(larger) <= T(0.0);
  const T shift = d[first] - (e[first] * e[first]) / Select(none, T(1.0), larger);

  // The bulge runs up from row `end`: (diagonal, bulge) is what the next rotation makes (r, 0).
  T bulge = T(0.0), diagonal = T(0.0), c = T(1.0), moved = T(0.0);
  for (int i = N - 2; i >= first; --i) {
    const auto inside = T(double(i)) < end;
    if (!Any(inside)) continue;
    const auto starts = end <= T(double(i + 1));
    diagonal = Select(starts, d[i + 1] - shift, diagonal);
    c = Select(starts, T(1.0), c);
    moved = Select(starts, T(0.0), moved);
    bulge = Select(starts, e[i], bulge);

    const T coupling = c * e[i];
    const T square = MulAdd(bulge, bulge, diagonal * diagonal);
    const auto still = square <= T(0.0);
    const T r = Sqrt(square);
    const T inverse = T(1.0) / Max(r, T(0x1p-1022));
    c = Select(still, T(1.0), diagonal * inverse);
    const T s = bulge * inverse;
    const T rest = d[i + 1] - moved;
    const T turned = MulAdd(d[i] - rest, s, T(2.0) * (c * coupling));
    moved = s * turned;
    diagonal = MulAdd(c, turned, -coupling);
    d[i + 1] = Select(inside, rest + moved, d[i + 1]);
    e[i + 1] = Select(inside, Select(starts, T(0.0), r), e[i + 1]);
    if (i > first) bulge = s * e[i - 1];

    const T by_c = Select(inside, c, T(1.0)), by_s = Select(inside, s, T(0.0));
    for (int k = 0; k < N; ++k) {
      const T upper = q[k][i], lower = q[k][i + 1];
      q[k][i] = MulAdd(by_c, upper, -(by_s * lower));
      q[k][i + 1] = MulAdd(by_s, upper, by_c * lower);
    }
  }
  const auto inside = T(double(first)) < end;
  d[first] = Select(inside, d[first] - moved, d[first]);
  e[first] = Select(inside, diagonal, e[first]);
}

// Reads the upper triangle. Couplings of at most `negligible` count as zero.
template <class T, int N>
EigenSystem<T, N> QlEigen(T (&a)[N][N], const T& negligible) {
  constexpr int kMostSteps = 30;  // for one eigenvalue; so that no rounding can make it endless
  EigenSystem<T, N> system;
  Tridiagonal<T, N> t = Tridiagonalise(a, system.vectors);
  for (int first = 0; first < N - 1; ++first) {
    for (int step = 0; step < kMostSteps; ++step) {
      T end = T(double(N - 1));
      for (int i = N - 2; i >= first; --i) {
        end = Select(Abs(t.coupling[i]) > negligible, end, T(double(i)));
      }
      if (!Any(end > T(double(first)))) break;
      QlStep(first, end, t, system.vectors);
    }
  }
  for (int m = 0; m < N; ++m) system.values[m] = t.diagonal[m];
  return system;
}

}  // namespace definite
