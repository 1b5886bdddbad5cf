#pragma once

// The form that the Hessian of every psi(l) has between two primitives. With the gradient along
// w (x) n each of its modes is v = w (x) t + r (x) n; w and r are rows over the edges of the
// stencil, of which the last has weight 1 in w and 0 in r. So a sum of modes is one symmetric 3x3
// matrix and, for each other edge, a vector and a row: 15 numbers, which take far less to add up
// than outer products of stacked vectors do, and which the vertices then add and subtract.
//
// Stencil: kVertices, kEdges, and kInEdges[vertex][edge], -1, 0 or 1: x_j = sum_e kInEdges[j][e] e.

#include "kernels/core/vec.hpp"

namespace definite {

// Modes in that form. kTurning: some mode has an r.
template <class T, class FrameStencil, int K, bool kTurning>
struct FramedModes {
  using Stencil = FrameStencil;
  static constexpr int kCount = K;
  T lambda[K];
  Vec3<T> t[K];
  Vec<T, Stencil::kEdges> r[K];
  bool turns[K];  // else r is zero, and not set
  Vec<T, Stencil::kEdges> w;
  Vec3<T> n;
};

// Their sum. Over edges e: the block (e, f) of the matrix is
//   w_e w_f S + w_e a_f n^T + n a_e^T w_f + C_ef n n^T.
template <class T, class FrameStencil, bool kTurning>
struct FramedSum {
  using Stencil = FrameStencil;
  static constexpr int kEdges = Stencil::kEdges;
  T s[3][3];            // sum lambda t t^T
  Vec3<T> a[kEdges];    // sum lambda r_e t; of the last edge zero, and not set
  T c[kEdges][kEdges];  // sum lambda r_e r_f for e <= f, likewise
  Vec<T, kEdges> w;
  Vec3<T> n;
};

namespace internal {

// sum_e sign[e] term(e) over edges where sign is not 0, times the sign of the first of these.
template <int kEdges, class T, class Term>
DEFINITE_INLINE T SignedSum(const int (&sign)[kEdges], Term term) {
  T sum{};
  int first = 0;
#pragma GCC unroll 4
  for (int e = 0; e < kEdges; ++e) {
    if (sign[e] == 0) continue;
    if (first == 0) {
      first = sign[e];
      sum = term(e);
    } else {
      sum = sign[e] == first ? sum + term(e) : sum - term(e);
    }
  }
  return sum;
}

template <int kEdges>
constexpr int FirstSign(const int (&sign)[kEdges]) {
  for (int s : sign) {
    if (s != 0) return s;
  }
  return 0;
}

// The vertex that has an edge alone, with weight 1; -1 if none has.
template <class Stencil>
constexpr int VertexOf(int edge) {
  for (int j = 0; j < Stencil::kVertices; ++j) {
    bool alone = true;
    for (int e = 0; e < Stencil::kEdges; ++e) {
      alone = alone && Stencil::kInEdges[j][e] == (e == edge ? 1 : 0);
    }
    if (alone) return j;
  }
  return -1;
}

// Where entry (i, j), j >= i, lies in the upper triangle of `size` rows.
constexpr int PackedIndex(int i, int j, int size) { return i * size - i * (i - 1) / 2 + j - i; }

}  // namespace internal

// A row over the edges as one over the vertices.
template <class Stencil, class T>
DEFINITE_INLINE Vec<T, Stencil::kVertices> OverVertices(const Vec<T, Stencil::kEdges>& row) {
  Vec<T, Stencil::kVertices> all;
#pragma GCC unroll 4
  for (int j = 0; j < Stencil::kVertices; ++j) {
    const T sum = internal::SignedSum<Stencil::kEdges, T>(
        Stencil::kInEdges[j], [&](int e) __attribute__((always_inline)) { return row[e]; });
    all[j] = internal::FirstSign(Stencil::kInEdges[j]) < 0 ? -sum : sum;
  }
  return all;
}

// A row over the vertices as one over the edges; that of the last edge is known.
template <class Stencil, class T>
DEFINITE_INLINE Vec<T, Stencil::kEdges> OverEdges(const Vec<T, Stencil::kVertices>& row,
                                                  double last) {
  constexpr int kLast = Stencil::kEdges - 1;
  Vec<T, Stencil::kEdges> edges;
#pragma GCC unroll 2
  for (int e = 0; e < kLast; ++e) edges[e] = row[internal::VertexOf<Stencil>(e)];
  edges[kLast] = T(last);
  return edges;
}

// Adds lambda v v^T to the upper half of s, to a and to c.
template <class T, class Stencil, bool kTurning>
DEFINITE_INLINE void AddMode(const T& lambda, const Vec3<T>& t,
                             FramedSum<T, Stencil, kTurning>& sum) {
  const Vec3<T> scaled = lambda * t;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = i; j < 3; ++j) sum.s[i][j] = MulAdd(scaled[i], t[j], sum.s[i][j]);
  }
}
template <class T, class Stencil>
DEFINITE_INLINE void AddMode(const T& lambda, const Vec3<T>& t, const Vec<T, Stencil::kEdges>& r,
                             FramedSum<T, Stencil, true>& sum) {
  constexpr int kLast = Stencil::kEdges - 1;
  AddMode(lambda, t, sum);
#pragma GCC unroll 2
  for (int e = 0; e < kLast; ++e) {
    const T weight = lambda * r[e];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) sum.a[e][i] = MulAdd(weight, t[i], sum.a[e][i]);
#pragma GCC unroll 2
    for (int f = e; f < kLast; ++f) sum.c[e][f] = MulAdd(weight, r[f], sum.c[e][f]);
  }
}

// Once all are added: the lower half of s.
template <class T, class Stencil, bool kTurning>
DEFINITE_INLINE void Mirror(FramedSum<T, Stencil, kTurning>& sum) {
#pragma GCC unroll 3
  for (int i = 1; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < i; ++j) sum.s[i][j] = sum.s[j][i];
  }
}

template <class T, class Stencil, int K, bool kTurning>
DEFINITE_INLINE FramedSum<T, Stencil, kTurning> SumOf(
    const FramedModes<T, Stencil, K, kTurning>& modes) {
  constexpr int kLast = Stencil::kEdges - 1;
  FramedSum<T, Stencil, kTurning> sum;
  sum.w = modes.w;
  sum.n = modes.n;
  bool first = true;
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) {
    const Vec3<T> scaled = modes.lambda[m] * modes.t[m];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
      for (int j = i; j < 3; ++j) {
        sum.s[i][j] =
            m == 0 ? scaled[i] * modes.t[m][j] : MulAdd(scaled[i], modes.t[m][j], sum.s[i][j]);
      }
    }
    if (!modes.turns[m]) continue;
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      const T weight = modes.lambda[m] * modes.r[m][e];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        sum.a[e][i] = first ? weight * modes.t[m][i] : MulAdd(weight, modes.t[m][i], sum.a[e][i]);
      }
#pragma GCC unroll 2
      for (int f = e; f < kLast; ++f) {
        sum.c[e][f] = first ? weight * modes.r[m][f] : MulAdd(weight, modes.r[m][f], sum.c[e][f]);
      }
    }
    first = false;
  }
  Mirror(sum);
  return sum;
}

template <class T, class Stencil, bool kTurning>
DEFINITE_INLINE const FramedSum<T, Stencil, kTurning>& SumOf(
    const FramedSum<T, Stencil, kTurning>& sum) {
  return sum;
}

// Calls store(k, value) for each entry of the packed matrix, in no particular order.
template <class T, class Stencil, class Store>
DEFINITE_INLINE void ForPacked(const FramedSum<T, Stencil, false>& sum, Store store) {
  const Vec<T, Stencil::kVertices> w = OverVertices<Stencil>(sum.w);
#pragma GCC unroll 4
  for (int i = 0; i < Stencil::kVertices; ++i) {
#pragma GCC unroll 4
    for (int j = i; j < Stencil::kVertices; ++j) {
      const T weight = w[i] * w[j];
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) {
#pragma GCC unroll 3
        for (int m = k; m < 3; ++m) {
          const T value = weight * sum.s[k][m];
          store(internal::PackedIndex(3 * i + k, 3 * j + m, 3 * Stencil::kVertices), value);
          if (i != j && k != m) {
            store(internal::PackedIndex(3 * i + m, 3 * j + k, 3 * Stencil::kVertices), value);
          }
        }
      }
    }
  }
}
template <class T, class Stencil, class Store>
DEFINITE_INLINE void ForPacked(const FramedSum<T, Stencil, true>& sum, Store store) {
  constexpr int kVertices = Stencil::kVertices, kEdges = Stencil::kEdges, kLast = kEdges - 1;
  T block[kEdges][kEdges][3][3];  // of edges e <= f
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      block[kLast][kLast][i][j] = sum.s[i][j];
#pragma GCC unroll 2
      for (int e = 0; e < kLast; ++e) {
        block[e][kLast][j][i] = MulAdd(sum.a[e][i], sum.n[j], sum.w[e] * sum.s[i][j]);
      }
    }
  }
#pragma GCC unroll 2
  for (int e = 0; e < kLast; ++e) {
#pragma GCC unroll 2
    for (int f = e; f < kLast; ++f) {
      Vec3<T> along_n;
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j)
        along_n[j] = MulAdd(sum.c[e][f], sum.n[j], sum.w[f] * sum.a[e][j]);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = e == f ? i : 0; j < 3; ++j) {
          block[e][f][i][j] = MulAdd(sum.n[i], along_n[j], sum.w[e] * block[f][kLast][j][i]);
          if (e == f) block[e][f][j][i] = block[e][f][i][j];
        }
      }
    }
  }
  // Columns of the vertices, then their rows; without the sign of a vertex's first edge.
  T column[kEdges][kVertices][3][3];
#pragma GCC unroll 3
  for (int e = 0; e < kEdges; ++e) {
#pragma GCC unroll 4
    for (int v = 0; v < kVertices; ++v) {
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = 0; j < 3; ++j) {
          column[e][v][i][j] = internal::SignedSum<kEdges, T>(
              Stencil::kInEdges[v], [&](int f) __attribute__((always_inline)) {
                return e <= f ? block[e][f][i][j] : block[f][e][j][i];
              });
        }
      }
    }
  }
#pragma GCC unroll 4
  for (int u = 0; u < kVertices; ++u) {
#pragma GCC unroll 4
    for (int v = u; v < kVertices; ++v) {
      const bool minus =
          internal::FirstSign(Stencil::kInEdges[u]) != internal::FirstSign(Stencil::kInEdges[v]);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = u == v ? i : 0; j < 3; ++j) {
          const T entry = internal::SignedSum<kEdges, T>(
              Stencil::kInEdges[u], [&](int e) __attribute__((always_inline)) {
                return column[e][v][i][j];
              });
          store(internal::PackedIndex(3 * u + i, 3 * v + j, 3 * kVertices), minus ? -entry : entry);
        }
      }
    }
  }
}
template <class T, class Stencil, int K, bool kTurning, class Store>
DEFINITE_INLINE void ForPacked(const FramedModes<T, Stencil, K, kTurning>& modes, Store store) {
  ForPacked(SumOf(modes), store);
}

// F d, matrix-free.
template <class T, class Stencil, bool kTurning>
DEFINITE_INLINE auto Applied(const FramedSum<T, Stencil, kTurning>& sum,
                             const Vec<T, 3 * Stencil::kVertices>& d) {
  constexpr int kVertices = Stencil::kVertices, kEdges = Stencil::kEdges, kLast = kEdges - 1;
  // What meets edge e, sum_j kInEdges[j][e] d_j; and w of it.
  Vec3<T> at[kEdges], all;
#pragma GCC unroll 3
  for (int e = kLast; e >= 0; --e) {
    int sign[kVertices];
#pragma GCC unroll 4
    for (int v = 0; v < kVertices; ++v) sign[v] = Stencil::kInEdges[v][e];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const T met = internal::SignedSum<kVertices, T>(
          sign, [&](int v) __attribute__((always_inline)) { return d[3 * v + i]; });
      at[e][i] = internal::FirstSign(sign) < 0 ? -met : met;
      all[i] = e == kLast ? at[e][i] : MulAdd(sum.w[e], at[e][i], all[i]);
    }
  }
  Vec3<T> push;  // S all + sum a_e (n . at_e)
  Vec<T, kEdges> of_edge, along_n;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    push[i] = sum.s[i][0] * all[0];
#pragma GCC unroll 3
    for (int j = 1; j < 3; ++j) push[i] = MulAdd(sum.s[i][j], all[j], push[i]);
  }
  if constexpr (kTurning) {
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      along_n[e] = Dot(sum.n, at[e]);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) push[i] = MulAdd(sum.a[e][i], along_n[e], push[i]);
    }
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      of_edge[e] = Dot(sum.a[e], all);
#pragma GCC unroll 2
      for (int f = 0; f < kLast; ++f) {
        of_edge[e] = MulAdd(e <= f ? sum.c[e][f] : sum.c[f][e], along_n[f], of_edge[e]);
      }
    }
  }
  Vec3<T> force[kEdges];
#pragma GCC unroll 3
  for (int e = 0; e < kEdges; ++e) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      force[e][i] = e == kLast ? push[i] : sum.w[e] * push[i];
      if (kTurning && e < kLast) force[e][i] = MulAdd(of_edge[e], sum.n[i], force[e][i]);
    }
  }
  Vec<T, 3 * kVertices> y;
#pragma GCC unroll 4
  for (int v = 0; v < kVertices; ++v) {
    const bool minus = internal::FirstSign(Stencil::kInEdges[v]) < 0;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const T total = internal::SignedSum<kEdges, T>(
          Stencil::kInEdges[v], [&](int e) __attribute__((always_inline)) { return force[e][i]; });
      y[3 * v + i] = minus ? -total : total;
    }
  }
  return y;
}
template <class T, class Stencil, int K, bool kTurning>
DEFINITE_INLINE auto Applied(const FramedModes<T, Stencil, K, kTurning>& modes,
                             const Vec<T, 3 * Stencil::kVertices>& d) {
  return Applied(SumOf(modes), d);
}

}  // namespace definite
