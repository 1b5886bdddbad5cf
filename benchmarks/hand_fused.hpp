#pragma once

// What someone would write by hand for one case only: the analytic filter of signed vertex-face
// with the quadratic penalty, all in one loop, without modes, stencils or penalties. It is here to
// show what the abstraction of kernels/ costs (docs/architecture.md).

#include "kernels/core/lanes.hpp"
#include "kernels/core/mathfun.hpp"

namespace definite {

// x: 12 numbers a configuration, p: k, eps, side; out: 78 numbers. Tiles of eight.
inline void HandFusedAnalytic(const double* x, const double* p, double* out, long tiles) {
  constexpr int kW = 8;
  using L = Lanes<double, kNativeLanes>;
  for (long tile = 0; tile < tiles; ++tile) {
    for (int w = 0; w < kW; w += kNativeLanes) {
      const double* xt = x + tile * 12 * kW + w;
      const double* pt = p + tile * 3 * kW + w;
      double* ot = out + tile * 78 * kW + w;
      L e0[3], e1[3], e2[3];
      L largest(0.0);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        const L x2 = L::Load(xt + (6 + i) * kW);
        e0[i] = L::Load(xt + (3 + i) * kW) - x2;
        e1[i] = L::Load(xt + (9 + i) * kW) - x2;
        e2[i] = L::Load(xt + i * kW) - x2;
        largest = Max(Max(largest, Abs(e0[i])), Max(Abs(e1[i]), Abs(e2[i])));
      }
      L lift(1.0);
      const auto subnormal = largest < L(0x1p-1022);
      if (Any(subnormal)) [[unlikely]] {
        lift = Select(subnormal, L(0x1p54), L(1.0));
        largest = largest * lift;
        for (int i = 0; i < 3; ++i)
          e0[i] = lift * e0[i], e1[i] = lift * e1[i], e2[i] = lift * e2[i];
      }
      const L scale = InversePowerOfTwo(Max(largest, L(0x1p-1022)));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        e0[i] = scale * e0[i];
        e1[i] = scale * e1[i];
        e2[i] = scale * e2[i];
      }
      const auto cross = [](const L* a, const L* b, L* c) __attribute__((always_inline)) {
        c[0] = a[1] * b[2] - a[2] * b[1];
        c[1] = a[2] * b[0] - a[0] * b[2];
        c[2] = a[0] * b[1] - a[1] * b[0];
      };
      const auto dot = [](const L* a, const L* b) __attribute__((always_inline)) {
        return MulAdd(a[2], b[2], MulAdd(a[1], b[1], a[0] * b[0]));
      };
      L n[3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const L product = e0[k] * e1[j];
        n[i] = MulAdd(e0[j], e1[k], -product) + MulAdd(-e0[k], e1[j], product);
      }
      const L area2 = dot(n, n), aa = dot(e0, e0), bb = dot(e1, e1);
      const L least = Max(L(1e-16) * (aa * bb), L(1e-16 * 0x1p-224));
      const auto outside = (area2 <= least) | (Min(aa, bb) <= L(0x1p-112));
      const L area = Sqrt(Max(area2, least)), a = Sqrt(Max(aa, L(0x1p-112)));
      const L ia = L(1.0) / area;
      const L inverse[2] = {L(1.0) / a, a * ia};
      L t[2][3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        n[i] = ia * n[i];
        t[0][i] = inverse[0] * e0[i];
      }
      cross(n, t[0], t[1]);
      const L along_e1 = dot(t[0], e1), alpha = along_e1 * inverse[0];
      const L on_t0 = dot(t[0], e2), on_t1 = dot(t[1], e2);
      const L beta = MulAdd(area * inverse[0], on_t0, -(along_e1 * on_t1)) * ia;
      const L gamma = on_t1 * inverse[1];
      const L sign = Select(L::Load(pt + 2 * kW) < L(0.0), L(-1.0), L(1.0));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) n[i] = sign * n[i];
      const L l = dot(n, e2);
      const L k = L::Load(pt), eps = L::Load(pt + kW) * lift * scale;
      const auto idle = (l >= eps) | outside;
      const L psi1 = Select(idle, L(0.0), (k + k) * (l - eps));
      const L psi2 = Select(idle, L(0.0), k + k);

      // Over the edges e0, e1, e2 with the weights -beta, -gamma, 1: F is one symmetric 3x3 matrix
      // and, for e0 and e1, a vector along n and a number along n n^T.
      L sum[3][3], along[2][3], c[3];  // c: of (e0, e0), (e0, e1), (e1, e1)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = i; j < 3; ++j) sum[i][j] = (psi2 * n[i]) * n[j];
      }
#pragma GCC unroll 2
      for (int m = 0; m < 2; ++m) {
        const L half = L(0.5) * inverse[m], r = l * half;
        const L h = Sqrt(MulAdd(r, r, L(1.0))), larger = h + Abs(r), q = L(1.0) / (h * larger);
        const L tau = Select(r < L(0.0), q * h, larger);
        const L lambda = -(psi1 * half * (q * larger));
        const L kept = Max(L(0.0), lambda);
        // Rows over e0 and e1: tau (1, 0) and tau (-alpha, 1).
        const L row = m == 0 ? tau : tau * -alpha;
        const L weight = kept * row, other = kept * tau;
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
          for (int j = i; j < 3; ++j) sum[i][j] = MulAdd(kept * t[m][i], t[m][j], sum[i][j]);
          along[0][i] = m == 0 ? weight * t[m][i] : MulAdd(weight, t[m][i], along[0][i]);
          if (m == 1) along[1][i] = other * t[m][i];
        }
        c[0] = m == 0 ? weight * row : MulAdd(weight, row, c[0]);
        if (m == 1) c[1] = other * row, c[2] = other * tau;
      }
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = 0; j < i; ++j) sum[i][j] = sum[j][i];
      }
      // Of the vertices x0 = e2, x1 = e0, x2 = -(e0 + e1 + e2), x3 = e1.
      const L weight[4] = {L(1.0), -beta, -((-beta - gamma) + L(1.0)), -gamma};
      L turn[4][3], number[4][4];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        turn[1][i] = along[0][i];
        turn[2][i] = -(along[0][i] + along[1][i]);
        turn[3][i] = along[1][i];
      }
      number[1][1] = c[0];
      number[1][2] = -(c[0] + c[1]);
      number[1][3] = c[1];
      number[2][2] = (c[0] + c[1]) + (c[1] + c[2]);
      number[2][3] = -(c[1] + c[2]);
      number[3][3] = c[2];
#pragma GCC unroll 4
      for (int v = 0; v < 4; ++v) {
        L column[3][3];
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j) {
            column[i][j] = weight[v] * sum[i][j];
            if (v != 0) column[i][j] = MulAdd(turn[v][i], n[j], column[i][j]);
          }
        }
#pragma GCC unroll 4
        for (int u = 0; u <= v; ++u) {
#pragma GCC unroll 3
          for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
            for (int j = u == v ? i : 0; j < 3; ++j) {
              L value = weight[u] * column[i][j];
              if (u != 0) {
                value = MulAdd(n[i], MulAdd(number[u][v], n[j], weight[v] * turn[u][j]), value);
              }
              const int row = 3 * u + i, at = row * 12 - row * (row - 1) / 2 + 3 * v + j - row;
              value.Store(ot + at * kW);
            }
          }
        }
      }
    }
  }
}

}  // namespace definite
