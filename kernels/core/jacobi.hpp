#pragma once

// Eigensystems of small symmetric matrices without a branch, and what the nearest PSD matrix makes
// of them.

#include "kernels/core/symmetric2.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// values[m] belongs to the unit vector vectors[.][m].
template <class T, int N>
struct EigenSystem {
  T values[N], vectors[N][N];
};

// Turns (x, y) by the angle of cosine c and sine s.
template <class T>
DEFINITE_INLINE void Turn(T& x, T& y, const T& c, const T& s) {
  const T old = x;
  x = MulAdd(s, y, c * old);
  y = MulAdd(c, y, -(s * old));
}

// Turns all that a rotation of rows p < q touches, but for what it does to these two themselves.
template <class T, int N>
DEFINITE_INLINE void TurnOthers(int p, int q, const T& c, const T& s, T (&a)[N][N],
                                T (&vectors)[N][N]) {
#pragma GCC unroll 4
  for (int i = 0; i < p; ++i) Turn(a[i][p], a[i][q], c, s);
#pragma GCC unroll 4
  for (int i = p + 1; i < q; ++i) Turn(a[p][i], a[i][q], c, s);
#pragma GCC unroll 4
  for (int i = q + 1; i < N; ++i) Turn(a[p][i], a[q][i], c, s);
#pragma GCC unroll 4
  for (int i = 0; i < N; ++i) Turn(vectors[i][p], vectors[i][q], c, s);
}

// Cyclic Jacobi rotations, a fixed number of sweeps: convergence is quadratic once the entries off
// the diagonal are small, and what is left after the last sweep is below rounding. Reads the upper
// triangle.
template <class T, int N>
DEFINITE_INLINE EigenSystem<T, N> JacobiEigen(T (&a)[N][N]) {
  constexpr int kSweeps = N <= 3 ? 5 : N <= 5 ? 7 : 9;
  EigenSystem<T, N> e;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) e.vectors[i][j] = T(i == j ? 1.0 : 0.0);
  }
  const auto rotate = [&](int p, int q) {
    const auto [first, second, c, s] = SymmetricEigen2(a[p][p], a[p][q], a[q][q]);
    a[p][p] = first;
    a[q][q] = second;
    a[p][q] = T(0.0);
    TurnOthers(p, q, c, s, a, e.vectors);
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if constexpr (N <= 5) {
#pragma GCC unroll 4
      for (int p = 0; p < N - 1; ++p) {
#pragma GCC unroll 4
        for (int q = p + 1; q < N; ++q) rotate(p, q);
      }
    } else {
      for (int p = 0; p < N - 1; ++p) {
        for (int q = p + 1; q < N; ++q) rotate(p, q);
      }
    }
  }
  for (int m = 0; m < N; ++m) e.values[m] = a[m][m];
  return e;
}

// The same with entries of at most `negligible` left as they are, until a sweep finds no other.
// Each lane does what it would do alone. A sweep goes in rounds of disjoint pairs, p + q = round
// modulo N (or N - 1, where the last row meets the one that is left over): their angles do not wait
// for each other.
template <class T, int N>
EigenSystem<T, N> JacobiEigenInRounds(T (&a)[N][N], const T& negligible) {
  constexpr int kMostSweeps = 15;  // not needed; so that no rounding can make it endless
  constexpr int kRounds = N % 2 == 0 ? N - 1 : N, kPairs = N / 2;
  EigenSystem<T, N> e;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) e.vectors[i][j] = T(i == j ? 1.0 : 0.0);
  }
  bool turned = true;
  for (int sweep = 0; turned && sweep < kMostSweeps; ++sweep) {
    turned = false;
    for (int round = 0; round < kRounds; ++round) {
      int p[kPairs], q[kPairs];
      T c[kPairs], s[kPairs];
      bool any[kPairs];
      int pairs = 0;
      for (int i = 0; i < kRounds; ++i) {
        int j = (round - i + kRounds) % kRounds;
        if (j == i && N % 2 == 0) j = N - 1;
        if (j <= i) continue;
        p[pairs] = i;
        q[pairs++] = j;
      }
      for (int k = 0; k < kPairs; ++k) {
        T& first = a[p[k]][p[k]];
        T& entry = a[p[k]][q[k]];
        T& second = a[q[k]][q[k]];
        const auto turns = Abs(entry) > negligible;
        any[k] = Any(turns);
        const auto system = SymmetricEigen2(first, entry, second);
        first = Select(turns, system.first, first);
        second = Select(turns, system.second, second);
        entry = Select(turns, T(0.0), entry);
        c[k] = Select(turns, system.c, T(1.0));
        s[k] = Select(turns, system.s, T(0.0));
      }
      for (int k = 0; k < kPairs; ++k) {
        if (!any[k]) continue;
        TurnOthers(p[k], q[k], c[k], s[k], a, e.vectors);
        turned = true;
      }
    }
  }
  for (int m = 0; m < N; ++m) e.values[m] = a[m][m];
  return e;
}

// The positive part of a sum of modes: they span at most K dimensions, in which an orthonormal
// basis (Gram-Schmidt, twice) leaves a K x K matrix.
template <class T, int D, int K>
Modes<T, D, K> NearestPsd(const Modes<T, D, K>& modes) {
  Vec<T, D> q[K];
  T r[K][K];  // modes.v[m] = sum_j r[j][m] q[j]
  for (int m = 0; m < K; ++m) {
    Vec<T, D> v = modes.v[m];
    for (int j = 0; j < K; ++j) r[j][m] = T(0.0);
    for (int pass = 0; pass < 2; ++pass) {
      for (int j = 0; j < m; ++j) {
        const T along = Dot(q[j], v);
        r[j][m] = r[j][m] + along;
        v = v - along * q[j];
      }
    }
    const T norm = Sqrt(Dot(v, v));
    r[m][m] = norm;
    const auto none = norm <= T(0.0);
    q[m] = Select(none, T(0.0), T(1.0) / Select(none, T(1.0), norm)) * v;
  }
  T a[K][K];
  for (int i = 0; i < K; ++i) {
    for (int j = i; j < K; ++j) {
      a[i][j] = T(0.0);
      for (int m = j; m < K; ++m) a[i][j] = MulAdd(modes.lambda[m] * r[i][m], r[j][m], a[i][j]);
    }
  }
  const EigenSystem<T, K> e = JacobiEigen(a);
  Modes<T, D, K> positive;
  for (int m = 0; m < K; ++m) {
    positive.lambda[m] = Select(e.values[m] < T(0.0), T(0.0), e.values[m]);
    positive.v[m] = e.vectors[0][m] * q[0];
    for (int j = 1; j < K; ++j) positive.v[m] = positive.v[m] + e.vectors[j][m] * q[j];
  }
  return positive;
}

// Turns vectors r by reflections that put the heaviest mode, of weight |lambda| |r|^2, on the first
// axis, the heaviest of what is left on the second, and so on. Where as many outweigh all others,
// their sum is graded then, and rotations lose nothing of what is small.
template <int kReflections, class T, int N, int K>
struct HeaviestFirst {
  Vec<T, N> mirror[kReflections];  // v -> v - factor (mirror.v) mirror
  T factor[kReflections];

  HeaviestFirst(const T (&lambda)[K], Vec<T, N> (&r)[K]) {
    for (int axis = 0; axis < kReflections; ++axis) {
      T most = T(-1.0), which = T(0.0);
      Vec<T, N> u = r[0];
      for (int m = 0; m < K; ++m) {
        T squared = T(0.0);
        for (int i = axis; i < N; ++i) squared = MulAdd(r[m][i], r[m][i], squared);
        const T weight = Abs(lambda[m]) * squared;
        const auto heavier = weight > most;
        most = Select(heavier, weight, most);
        which = Select(heavier, T(m), which);
        for (int i = 0; i < N; ++i) u[i] = Select(heavier, r[m][i], u[i]);
      }
      for (int i = 0; i < axis; ++i) u[i] = T(0.0);
      const T squared = Dot(u, u), norm = Sqrt(squared);
      u[axis] = u[axis] + Select(u[axis] < T(0.0), -norm, norm);
      const T length2 = Dot(u, u);
      const auto none = length2 <= T(0.0);
      factor[axis] = Select(none, T(0.0), T(2.0) / Select(none, T(1.0), length2));
      mirror[axis] = u;
      for (int m = 0; m < K; ++m) {
        Reflect(axis, r[m]);
        const auto chosen = Abs(which - T(m)) < T(0.5);
        for (int i = axis + 1; i < N; ++i) r[m][i] = Select(chosen, T(0.0), r[m][i]);
      }
    }
  }

  void Reflect(int axis, Vec<T, N>& v) const {
    v = v - (factor[axis] * Dot(mirror[axis], v)) * mirror[axis];
  }
  void TurnBack(Vec<T, N>& v) const {
    for (int axis = kReflections - 1; axis >= 0; --axis) Reflect(axis, v);
  }
};

// The same of modes over four points that no translation changes: those are 9 dimensions with a
// basis of constants, halves of (1, 1, -1, -1), (1, -1, 1, -1) and (1, -1, -1, 1).
template <int kHeavy = 2, class T, int K>
Modes<T, 12, 9> NearestPsdOfFour(const Modes<T, 12, K>& modes) {
  const T half = T(0.5);
  Vec<T, 9> r[K];
  for (int m = 0; m < K; ++m) {
    for (int i = 0; i < 3; ++i) {
      const T d01 = modes.v[m][i] - modes.v[m][3 + i], d23 = modes.v[m][6 + i] - modes.v[m][9 + i];
      const T s01 = modes.v[m][i] + modes.v[m][3 + i], s23 = modes.v[m][6 + i] + modes.v[m][9 + i];
      r[m][i] = half * (s01 - s23);
      r[m][3 + i] = half * (d01 + d23);
      r[m][6 + i] = half * (d01 - d23);
    }
  }
  const HeaviestFirst<kHeavy, T, 9, K> turned(modes.lambda, r);
  T a[9][9];
  for (int i = 0; i < 9; ++i) {
    for (int j = i; j < 9; ++j) {
      a[i][j] = (modes.lambda[0] * r[0][i]) * r[0][j];
      for (int m = 1; m < K; ++m) a[i][j] = MulAdd(modes.lambda[m] * r[m][i], r[m][j], a[i][j]);
    }
  }
  const EigenSystem<T, 9> e = JacobiEigen(a);
  Modes<T, 12, 9> positive;
  for (int m = 0; m < 9; ++m) {
    positive.lambda[m] = Select(e.values[m] < T(0.0), T(0.0), e.values[m]);
    Vec<T, 9> z;
    for (int i = 0; i < 9; ++i) z[i] = half * e.vectors[i][m];
    turned.TurnBack(z);
    for (int i = 0; i < 3; ++i) {
      const T z0 = z[i], z1 = z[3 + i], z2 = z[6 + i];
      positive.v[m][i] = z0 + (z1 + z2);
      positive.v[m][3 + i] = z0 - (z1 + z2);
      positive.v[m][6 + i] = (z1 - z2) - z0;
      positive.v[m][9 + i] = (z2 - z1) - z0;
    }
  }
  return positive;
}

}  // namespace definite
