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
      const L lift = Select(largest < L(0x1p-1022), L(0x1p54), L(1.0));
      const L scale = InversePowerOfTwo(Max(largest * lift, L(0x1p-1022)));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        e0[i] = scale * (lift * e0[i]);
        e1[i] = scale * (lift * e1[i]);
        e2[i] = scale * (lift * e2[i]);
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
      cross(e0, e1, n);
      L area2 = dot(n, n), aa = dot(e0, e0);
      const auto outside = area2 <= Max(L(1e-16) * (aa * dot(e1, e1)), L(0x1p-900));
      area2 = Select(outside, L(1.0), area2);
      aa = Select(outside, L(1.0), aa);
      const L area = Sqrt(area2), a = Sqrt(aa);
      const L ia = L(1.0) / area;
      const L inverse[2] = {L(1.0) / a, a * ia};
      L t[2][3], d[3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        n[i] = ia * n[i];
        t[0][i] = inverse[0] * e0[i];
      }
      cross(n, t[0], t[1]);
      const L alpha = dot(t[0], e1) * inverse[0];
      cross(e1, n, d);
      const L beta = dot(d, e2) * ia;
      cross(n, e0, d);
      const L gamma = dot(d, e2) * ia;
      const L sign = Select(L::Load(pt + 2 * kW) < L(0.0), L(-1.0), L(1.0));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) n[i] = sign * n[i];
      const L l = dot(n, e2);
      const L k = L::Load(pt), eps = L::Load(pt + kW) * lift * scale;
      const auto idle = (l >= eps) | outside;
      const L psi1 = Select(idle, L(0.0), (k + k) * (l - eps));
      const L psi2 = Select(idle, L(0.0), k + k);

      // Over the edges e0, e1, e2: F = sum of 3x3 blocks, of which the vertices are sums.
      const L of_w[2] = {-beta, -gamma};
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
        const L kept = Select(lambda < L(0.0), L(0.0), lambda);
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
        if (m == 1) c[1] = weight * tau, c[2] = other * tau;
      }
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = 0; j < i; ++j) sum[i][j] = sum[j][i];
      }
      L block[3][3][3][3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
        for (int j = 0; j < 3; ++j) {
          block[2][2][i][j] = sum[i][j];
#pragma GCC unroll 2
          for (int e = 0; e < 2; ++e) {
            block[2][e][i][j] = MulAdd(along[e][i], n[j], of_w[e] * sum[i][j]);
            block[e][2][j][i] = block[2][e][i][j];
          }
        }
      }
#pragma GCC unroll 2
      for (int e = 0; e < 2; ++e) {
#pragma GCC unroll 2
        for (int f = e; f < 2; ++f) {
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j) {
            const L rest = MulAdd(c[e + f], n[j], of_w[f] * along[e][j]);
#pragma GCC unroll 3
            for (int i = 0; i < 3; ++i) {
              if (e == f && i > j) continue;
              block[e][f][i][j] = MulAdd(n[i], rest, of_w[e] * block[f][2][j][i]);
              block[f][e][j][i] = block[e][f][i][j];
            }
          }
        }
      }
      // x0 = e2, x1 = e0, x2 = -(e0 + e1 + e2), x3 = e1.
      constexpr int kEdge[4] = {2, 0, -1, 1};
      L column[3][3][3];  // of x2, but for the sign
#pragma GCC unroll 3
      for (int e = 0; e < 3; ++e) {
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j) {
            column[e][i][j] = block[e][0][i][j] + block[e][1][i][j] + block[e][2][i][j];
          }
        }
      }
      int at = 0;
#pragma GCC unroll 12
      for (int i = 0; i < 12; ++i) {
#pragma GCC unroll 12
        for (int j = i; j < 12; ++j) {
          const int e = kEdge[i / 3], f = kEdge[j / 3], row = i % 3, col = j % 3;
          const L value = e >= 0 && f >= 0 ? block[e >= 0 ? e : 0][f >= 0 ? f : 0][row][col]
                          : e >= 0         ? -column[e >= 0 ? e : 0][row][col]
                          : f >= 0
                              ? -column[f >= 0 ? f : 0][col][row]
                              : column[0][row][col] + column[1][row][col] + column[2][row][col];
          value.Store(ot + at * kW);
          ++at;
        }
      }
    }
  }
}

}  // namespace definite
