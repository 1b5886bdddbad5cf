#pragma once

// What becomes of a filter's matrix: the outputs that a kernel can have. All but the frame consume
// the same result of the filter; kOfSum says whether they want a sum of modes or, better, the
// modes.

#include "kernels/core/applied.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// The upper triangle, row by row.
template <class E>
struct PackedOutput {
  static constexpr std::string_view kName = "packed";
  static constexpr int kNumbers = E::kDofs * (E::kDofs + 1) / 2, kStride = kNumbers;
  static constexpr bool kOfSum = true;

  template <class H, class Tile>
  static DEFINITE_INLINE void Write(const H& h, const Tile& tile) {
    ForPacked(
        h, [&tile](int k, const auto& value)
               __attribute__((always_inline)) { tile.Store(k, value); });
  }
};

// All entries, row by row.
template <class E>
struct DenseOutput {
  static constexpr std::string_view kName = "dense";
  static constexpr int kNumbers = E::kDofs * E::kDofs, kStride = kNumbers;
  static constexpr bool kOfSum = true;

  template <class H, class Tile>
  static DEFINITE_INLINE void Write(const H& h, const Tile& tile) {
    ForPacked(
        h, [&tile](int k, const auto& value) __attribute__((always_inline)) {
          constexpr auto kAt = Places();
          tile.Store(kAt.upper[k], value);
          if (kAt.lower[k] != kAt.upper[k]) tile.Store(kAt.lower[k], value);
        });
  }

 private:
  struct Table {
    int upper[PackedOutput<E>::kNumbers], lower[PackedOutput<E>::kNumbers];
  };
  static constexpr Table Places() {
    Table at{};
    for (int i = 0; i < E::kDofs; ++i) {
      for (int j = i; j < E::kDofs; ++j) {
        const int k = internal::PackedIndex(i, j, E::kDofs);
        at.upper[k] = i * E::kDofs + j;
        at.lower[k] = j * E::kDofs + i;
      }
    }
    return at;
  }
};

// y += F d, matrix-free: a tile holds y, which is added to, and then d, which is read.
template <class E>
struct AppliedOutput {
  static constexpr std::string_view kName = "applied";
  static constexpr int kNumbers = 2 * E::kDofs, kStride = kNumbers;
  static constexpr bool kOfSum = false;

  template <class H, class Tile>
  static DEFINITE_INLINE void Write(const H& h, const Tile& tile) {
    Vec<std::remove_cvref_t<decltype(tile.Load(0))>, E::kDofs> d;
#pragma GCC unroll 16
    for (int i = 0; i < E::kDofs; ++i) d[i] = tile.Load(E::kDofs + i);
    const auto f = Applied(h, d);
#pragma GCC unroll 16
    for (int i = 0; i < E::kDofs; ++i) tile.Store(i, tile.Load(i) + f[i]);
  }
};

// The packed matrices of a call added up, lane by lane, to what its one tile holds: for samples of
// one element, or pairs that share all vertices.
template <class E>
struct BlockSumOutput {
  static constexpr std::string_view kName = "block_sum";
  static constexpr int kNumbers = E::kDofs * (E::kDofs + 1) / 2, kStride = 0;
  static constexpr bool kOfSum = true;

  template <class H, class Tile>
  static DEFINITE_INLINE void Write(const H& h, const Tile& tile) {
    ForPacked(
        h, [&tile](int k, const auto& value)
               __attribute__((always_inline)) { tile.Store(k, tile.Load(k) + value); });
  }
};

// A stage on the way, to be timed: the filtered matrix in its framed form, before it is spread over
// the vertices.
template <class E>
struct FramedOutput {
  static constexpr std::string_view kName = "framed";
  static constexpr int kEdges = E::Stencil::kEdges;
  static constexpr int kNumbers = 6 + 4 * (kEdges - 1) + 3 + kEdges * (kEdges - 1) / 2,
                       kStride = kNumbers;
  static constexpr bool kOfSum = false;

  template <class H, class Tile>
  requires requires(const H& h) { SumOf(h); }
  static DEFINITE_INLINE void Write(const H& h, const Tile& tile) {
    const auto sum = SumOf(h);
    int at = 0;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      tile.Store(at++, sum.n[i]);
#pragma GCC unroll 3
      for (int j = i; j < 3; ++j) tile.Store(at++, sum.s[i][j]);
    }
#pragma GCC unroll 2
    for (int e = 0; e + 1 < kEdges; ++e) {
      tile.Store(at++, sum.w[e]);
      if constexpr (std::remove_cvref_t<decltype(sum)>::kTurns) {
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) tile.Store(at++, sum.a[e][i]);
#pragma GCC unroll 2
        for (int g = e; g + 1 < kEdges; ++g) tile.Store(at++, sum.c[e][g]);
      }
    }
  }
};

// A stage on the way, to be timed: the frame, which is the same for all filters; for one that says
// `kTimesFrame`.
template <class E>
struct FrameOutput {
  static constexpr std::string_view kName = "frame";
  static constexpr int kNumbers = 12 + 2 * (E::Stencil::kEdges - 1), kStride = kNumbers;
  static constexpr bool kOfSum = false;

  template <class F, class T, class Tile>
  requires requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    requires F::kTimesFrame;
    E::FrameOf(x, p);
  }
  static DEFINITE_INLINE void WriteOf(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p,
                                      const Tile& tile) {
    const auto f = E::FrameOf(x, p);
    tile.Store(0, f.l);
    int at = 1;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      tile.Store(at++, f.n[a]);
      tile.Store(at++, f.t[0][a]);
      tile.Store(at++, f.t[1][a]);
    }
#pragma GCC unroll 2
    for (int e = 0; e + 1 < E::Stencil::kEdges; ++e) {
      tile.Store(at++, f.w[e]);
      tile.Store(at++, f.rows[1][e]);
    }
    tile.Store(at++, f.inverse_length[0]);
    tile.Store(at++, f.inverse_length[1]);
  }
};

}  // namespace definite
