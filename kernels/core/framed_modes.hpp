#pragma once

// The form that the Hessian of every psi(l) has between two primitives. With the gradient along
// w (x) n each of its modes is v = w (x) t + r (x) n; w and r are rows over the edges of the
// stencil, of which the last has weight 1 in w and 0 in r. So a sum of modes is one symmetric 3x3
// matrix and, for each other edge, a vector and a row: 15 numbers, which take far less to add up
// than outer products of stacked vectors do.
//
// Stencil: kVertices, kEdges, and kInEdges[vertex][edge], -1, 0 or 1: x_j = sum_e kInEdges[j][e] e.

#include "kernels/core/vec.hpp"

namespace definite {

// Modes in that form. kTurning: some mode has an r.
template <class T, class FrameStencil, int K, bool kTurning>
struct FramedModes {
  using Stencil = FrameStencil;
  static constexpr int kCount = K;
  static constexpr bool kTurns = kTurning;
  T lambda[K];
  Vec3<T> t[K];
  Vec<T, Stencil::kEdges> r[K];
  int turns[K];  // edges that have an r, the first so many; that of the others is zero, and not set
  Vec<T, Stencil::kEdges> w;
  Vec3<T> n;
};

// Their sum. Over edges e: the block (e, f) of the matrix is
//   w_e w_f S + w_e a_f n^T + n a_e^T w_f + C_ef n n^T.
template <class T, class FrameStencil, bool kTurning>
struct FramedSum {
  using Stencil = FrameStencil;
  static constexpr int kEdges = Stencil::kEdges;
  static constexpr bool kTurns = kTurning;
  T s[3][3];            // sum lambda t t^T
  Vec3<T> a[kEdges];    // sum lambda r_e t; of the last edge zero, and not set
  T c[kEdges][kEdges];  // sum lambda r_e r_f for e <= f, likewise
  Vec<T, kEdges> w;
  Vec3<T> n;
};

namespace internal {

// sum_i sign[i] term(i) over the first kCount, of which at least one sign is not 0.
template <int kCount, class T, class Term>
DEFINITE_INLINE T SignedSum(const int* sign, Term term) {
  int first = 0;  // a positive one if there is one
#pragma GCC unroll 8
  for (int i = kCount - 1; i >= 0; --i) {
    if (sign[i] > 0 || (sign[i] < 0 && sign[first] <= 0)) first = i;
  }
  T sum = term(first);
#pragma GCC unroll 8
  for (int i = 0; i < kCount; ++i) {
    if (i == first || sign[i] == 0) continue;
    sum = sign[i] == sign[first] ? sum + term(i) : sum - term(i);
  }
  return sign[first] < 0 ? -sum : sum;
}

// The last weight of w is 1: said where w is used, so that the compiler knows.
template <class T, int kEdges>
DEFINITE_INLINE Vec<T, kEdges> WithLast(Vec<T, kEdges> w) {
  w[kEdges - 1] = T(1.0);
  return w;
}

// Whether a vertex is in an edge other than the last: then modes with an r turn it.
template <class Stencil>
constexpr bool Turns(int vertex) {
  for (int e = 0; e + 1 < Stencil::kEdges; ++e) {
    if (Stencil::kInEdges[vertex][e] != 0) return true;
  }
  return false;
}

// The inner product over the vertices of two edges.
template <class Stencil>
constexpr int Shared(int e, int f) {
  int sum = 0;
  for (const auto& in : Stencil::kInEdges) sum += in[e] * in[f];
  return sum;
}

// The Gram determinant over the vertices of the first `count` edges.
template <class Stencil>
constexpr int GramDeterminant(int count) {
  int a[Stencil::kEdges][Stencil::kEdges];
  for (int e = 0; e < count; ++e) {
    for (int f = 0; f < count; ++f) a[e][f] = Shared<Stencil>(e, f);
  }
  int last = 1;  // elimination without fractions (Bareiss): all divisions come out even
  for (int k = 0; k + 1 < count; ++k) {
    for (int e = k + 1; e < count; ++e) {
      for (int f = k + 1; f < count; ++f) {
        a[e][f] = (a[k][k] * a[e][f] - a[e][k] * a[k][f]) / last;
      }
    }
    last = a[k][k];
  }
  return a[count - 1][count - 1];
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
    all[j] = internal::SignedSum<Stencil::kEdges, T>(
        Stencil::kInEdges[j], [&](int e) __attribute__((always_inline)) { return row[e]; });
  }
  return all;
}

// The inner products over the vertices of each edge with a row over the edges, zero on the last. By
// additions, which have units of their own on some machines.
template <class Stencil, class T>
DEFINITE_INLINE Vec<T, Stencil::kEdges> WithEdges(const Vec<T, Stencil::kEdges>& row) {
  constexpr int kEdges = Stencil::kEdges, kMost = Stencil::kVertices;
  Vec<T, kEdges> products;
#pragma GCC unroll 3
  for (int e = 0; e < kEdges; ++e) {
    int sign[(kEdges - 1) * kMost] = {};  // row[f] as often as e and f share a vertex
#pragma GCC unroll 2
    for (int f = 0; f + 1 < kEdges; ++f) {
      const int shared = internal::Shared<Stencil>(e, f);
#pragma GCC unroll 4
      for (int i = 0; i < kMost; ++i) {
        if (i < shared || i < -shared) sign[f * kMost + i] = shared < 0 ? -1 : 1;
      }
    }
    products[e] = internal::SignedSum<(kEdges - 1) * kMost, T>(
        sign, [&](int i) __attribute__((always_inline)) { return row[i / kMost]; });
  }
  return products;
}

// The inner product over the vertices of two rows over the edges that are zero on the last.
template <class Stencil, class T>
DEFINITE_INLINE T InnerProduct(const Vec<T, Stencil::kEdges>& a, const Vec<T, Stencil::kEdges>& b) {
  const Vec<T, Stencil::kEdges> with_b = WithEdges<Stencil>(b);
  T sum = a[0] * with_b[0];
#pragma GCC unroll 2
  for (int e = 1; e + 1 < Stencil::kEdges; ++e) sum = MulAdd(a[e], with_b[e], sum);
  return sum;
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
  int edges = 0;  // edges that have been added to, the first so many
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
#pragma GCC unroll 2
    for (int f = 0; f < kLast; ++f) {
      if (f >= modes.turns[m]) break;
      const T weight = modes.lambda[m] * modes.r[m][f];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        sum.a[f][i] =
            f >= edges ? weight * modes.t[m][i] : MulAdd(weight, modes.t[m][i], sum.a[f][i]);
      }
#pragma GCC unroll 2
      for (int e = 0; e <= f; ++e) {
        sum.c[e][f] =
            f >= edges ? weight * modes.r[m][e] : MulAdd(weight, modes.r[m][e], sum.c[e][f]);
      }
    }
    edges = edges < modes.turns[m] ? modes.turns[m] : edges;
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
  constexpr int kVertices = Stencil::kVertices, kLast = Stencil::kEdges - 1;
  const Vec<T, kVertices> w = OverVertices<Stencil>(internal::WithLast(sum.w));
  Vec3<T> a[kVertices];
  T column[3][3];  // w_v S + a_v n^T
#pragma GCC unroll 4
  for (int v = 0; v < kVertices; ++v) {
    const bool turns = internal::Turns<Stencil>(v);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      if (turns) {
        a[v][i] = internal::SignedSum<kLast, T>(
            Stencil::kInEdges[v], [&](int e)
                                      __attribute__((always_inline)) { return sum.a[e][i]; });
      }
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        const T part = w[v] * (i < j ? sum.s[i][j] : sum.s[j][i]);
        column[i][j] = turns ? MulAdd(a[v][i], sum.n[j], part) : part;
      }
    }
#pragma GCC unroll 4
    for (int u = 0; u <= v; ++u) {
      Vec3<T> along_n;  // w_v a_u + c_uv n
      if (internal::Turns<Stencil>(u)) {
        along_n = w[v] * a[u];
        if (turns) {
          const T c = internal::SignedSum<kLast, T>(
              Stencil::kInEdges[u], [&](int e) __attribute__((always_inline)) {
                return internal::SignedSum<kLast, T>(
                    Stencil::kInEdges[v], [&](int f) __attribute__((always_inline)) {
                      return e <= f ? sum.c[e][f] : sum.c[f][e];
                    });
              });
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j) along_n[j] = MulAdd(c, sum.n[j], along_n[j]);
        }
      }
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = u == v ? i : 0; j < 3; ++j) {
          T entry = w[u] * column[i][j];
          if (internal::Turns<Stencil>(u)) entry = MulAdd(sum.n[i], along_n[j], entry);
          store(internal::PackedIndex(3 * u + i, 3 * v + j, 3 * kVertices), entry);
        }
      }
    }
  }
}
template <class T, class Stencil, int K, bool kTurning, class Store>
DEFINITE_INLINE void ForPacked(const FramedModes<T, Stencil, K, kTurning>& modes, Store store) {
  ForPacked(SumOf(modes), store);
}

// F d, that is the sum of w (x) push and row (x) n, row being zero on the last edge.
template <class T, int kEdges>
struct FramedVector {
  Vec3<T> push;
  Vec<T, kEdges> row;
};

// Of d, all = (w (x) I)^T d, and along_n[e] that of edge e along n.
template <class T, class Stencil, bool kTurning>
DEFINITE_INLINE auto AppliedInFrame(const FramedSum<T, Stencil, kTurning>& sum, const Vec3<T>& all,
                                    const Vec<T, Stencil::kEdges>& along_n) {
  constexpr int kLast = Stencil::kEdges - 1;
  FramedVector<T, Stencil::kEdges> f;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    f.push[i] = sum.s[i][0] * all[0];
#pragma GCC unroll 3
    for (int j = 1; j < 3; ++j) f.push[i] = MulAdd(sum.s[i][j], all[j], f.push[i]);
  }
  if constexpr (kTurning) {
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) f.push[i] = MulAdd(sum.a[e][i], along_n[e], f.push[i]);
      f.row[e] = Dot(sum.a[e], all);
#pragma GCC unroll 2
      for (int g = 0; g < kLast; ++g) {
        f.row[e] = MulAdd(e <= g ? sum.c[e][g] : sum.c[g][e], along_n[g], f.row[e]);
      }
    }
  }
  return f;
}
// Mode by mode: adding them up first would take twice the operations.
template <class T, class Stencil, int K, bool kTurning>
DEFINITE_INLINE auto AppliedInFrame(const FramedModes<T, Stencil, K, kTurning>& modes,
                                    const Vec3<T>& all, const Vec<T, Stencil::kEdges>& along_n) {
  constexpr int kLast = Stencil::kEdges - 1;
  FramedVector<T, Stencil::kEdges> f;
  int edges = 0;  // of the row, that have been set
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) {
    T along = Dot(modes.t[m], all);
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      if (e < modes.turns[m]) along = MulAdd(modes.r[m][e], along_n[e], along);
    }
    along = modes.lambda[m] * along;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      f.push[i] = m == 0 ? along * modes.t[m][i] : MulAdd(along, modes.t[m][i], f.push[i]);
    }
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      if (e >= modes.turns[m]) break;
      f.row[e] = e >= edges ? along * modes.r[m][e] : MulAdd(along, modes.r[m][e], f.row[e]);
    }
    edges = edges < modes.turns[m] ? modes.turns[m] : edges;
  }
  return f;
}

// F d, matrix-free, of modes in that form or of their sum.
template <class Framed, class T>
DEFINITE_INLINE Vec<T, 3 * Framed::Stencil::kVertices> Applied(
    const Framed& framed, const Vec<T, 3 * Framed::Stencil::kVertices>& d) {
  using Stencil = typename Framed::Stencil;
  constexpr int kVertices = Stencil::kVertices, kEdges = Stencil::kEdges, kLast = kEdges - 1;
  // What meets edge e, sum_j kInEdges[j][e] d_j; and w of it.
  Vec3<T> at[kEdges], all;
  Vec<T, kEdges> along_n;
#pragma GCC unroll 3
  for (int e = kLast; e >= 0; --e) {
    int sign[kVertices];
#pragma GCC unroll 4
    for (int v = 0; v < kVertices; ++v) sign[v] = Stencil::kInEdges[v][e];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      at[e][i] = internal::SignedSum<kVertices, T>(
          sign, [&](int v) __attribute__((always_inline)) { return d[3 * v + i]; });
      all[i] = e == kLast ? at[e][i] : MulAdd(framed.w[e], at[e][i], all[i]);
    }
    if (Framed::kTurns && e < kLast) along_n[e] = Dot(framed.n, at[e]);
  }
  const FramedVector<T, kEdges> f = AppliedInFrame(framed, all, along_n);
  Vec3<T> force[kEdges];
#pragma GCC unroll 3
  for (int e = 0; e < kEdges; ++e) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      force[e][i] = e == kLast ? f.push[i] : framed.w[e] * f.push[i];
      if (Framed::kTurns && e < kLast) force[e][i] = MulAdd(f.row[e], framed.n[i], force[e][i]);
    }
  }
  Vec<T, 3 * kVertices> y;
#pragma GCC unroll 4
  for (int v = 0; v < kVertices; ++v) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      y[3 * v + i] = internal::SignedSum<kEdges, T>(
          Stencil::kInEdges[v], [&](int e) __attribute__((always_inline)) { return force[e][i]; });
    }
  }
  return y;
}

}  // namespace definite
