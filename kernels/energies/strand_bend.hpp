#pragma once

// Bending of a strand, psi = mu/2 (theta - theta0)^2, theta the angle between its two edges.
//
// Source: Shi et al. 2023, Lifted Curls, supplement, section 1.
// Differs: turning angles omega = pi - theta, so that straight hair is exact; theta by atan2;
// eigenpairs of the printed tables corrected, each in-plane pair as a 2x2 block that is decomposed
// in closed form (their listed vectors vanish at rest); edges of any length, H = D^-1 H_unit D^-1
// with D = diag(|e0| I, |e1| I), since theta does not change with an edge's length.
// Parameters: mu (energy), omega0 = pi - theta0 (radians).
// Domain: both edges longer than kLeastStrandEdge (in any unit) and sin(theta) > 1e-8. Always active.

#include <string>

#include "kernels/core/precision.hpp"
#include "kernels/core/symmetric2.hpp"
#include "kernels/core/transcendental.hpp"
#include "kernels/registry.hpp"
#include "kernels/stencils/corner.hpp"

namespace definite {

inline constexpr double kLeastStrandEdge = 0x1p-450;  // of any unit

struct StrandBend {
  using Stencil = Corner;
  static constexpr int kDofs = 9, kParams = 2;
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness, an energy"},
      {"omega0", 0.5, 0, "turning angle at rest, pi - theta0, in radians"},
  };

  static std::string Name() { return "strand/bend/quadratic"; }
  static std::string Source() {
    return "Shi et al. 2023 (Lifted Curls), supplement, Eqs. 2-7, 37-42, corrected";
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, 9>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T d = p[1] - f.omega;
    return Select(f.outside, T(0.0), T(0.5) * p[0] * d * d);
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, 9> Gradient(const Vec<T, 9>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    return Slope(f, p) * PullBack(f, f.b0, T(-1.0) * f.b1);
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, 9>& x, const Vec<T, 2>&) {
    const T inside = Select(FrameOf(x).outside, T(0.0), T(1.0));
    return {inside, inside, T(0.0)};
  }

  template <Set kSet, Part kPart, class T>
  requires(kSet == Set::kFrame || kSet == Set::kExact) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, 9>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T mu = Select(f.outside, T(0.0), p[0]);
    if constexpr (kPart == Part::kCurvature) {
      return Modes<T, 9, 1>{{mu}, {PullBack(f, f.b0, T(-1.0) * f.b1)}};
    } else {
      // In units of mu, which may be far from 1: eigenvalues of a block square its entries.
      const T slope = Select(f.outside, T(0.0), p[1] - f.omega), f1 = mu * slope;
      const T half = T(0.5), none = T(0.0);
      const Vec3<T> minus_t1 = T(-1.0) * f.t1, minus_b1 = T(-1.0) * f.b1;
      // On ((t0; t1), (b0; -b1)) / sqrt 2 and ((t0; -t1), (b0; b1)) / sqrt 2; the halves below are
      // the squares of 1 / sqrt 2.
      const Vec<T, 9> u0 = PullBack(f, f.t0, f.t1), w0 = PullBack(f, f.b0, minus_b1);
      const Vec<T, 9> u1 = PullBack(f, f.t0, minus_t1), w1 = PullBack(f, f.b0, f.b1);
      const auto bend = SymmetricEigen2(none, -slope, T(2.0));
      Modes<T, 9, 6> modes;
      modes.lambda[0] = half * mu * bend.first;
      modes.v[0] = bend.c * u0 + bend.s * w0;
      modes.lambda[1] = half * mu * bend.second;
      modes.v[1] = (-bend.s) * u0 + bend.c * w0;
      // [[0, -f1], [-f1, 0]]: its eigenvectors are the diagonals.
      const T quarter = T(0.25);
      modes.lambda[2] = -(quarter * f1);
      modes.v[2] = u1 + w1;
      modes.lambda[3] = quarter * f1;
      modes.v[3] = u1 - w1;
      // Out of the plane, on (n; +-n) / sqrt 2.
      modes.lambda[4] = -(half * f1 * f.tan_half);
      modes.v[4] = PullBack(f, f.n, f.n);
      modes.lambda[5] = half * f1 * f.cot_half;
      modes.v[5] = PullBack(f, f.n, T(-1.0) * f.n);
      return modes;
    }
  }

 private:
  template <class T>
  struct Frame {
    MaskOf<T> outside;
    Vec3<T> t0, t1, n, b0, b1;    // unit tangents; normal of the plane; b_i = t_i x n
    T inverse0, inverse1;         // 1/|e0|, 1/|e1|
    T omega, tan_half, cot_half;  // of theta / 2
  };

  template <class T>
  static DEFINITE_INLINE Frame<T> FrameOf(const Vec<T, 9>& x) {
    const Vec3<T> x1 = Vertex(x, 1);
    Vec3<T> e[2] = {Vertex(x, 0) - x1, Vertex(x, 2) - x1};
    Frame<T> f;
    T inverse[2];
    T length_is_zero = T(0.0);
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      // A power of two keeps the squares in range.
      const T magnitude = Max(Max(Abs(e[i][0]), Abs(e[i][1])), Abs(e[i][2]));
      const auto none = magnitude <= T(kLeastStrandEdge);
      const T scale = Select(none, T(1.0), InversePowerOfTwo(Max(magnitude, T(kLeastStrandEdge))));
      const Vec3<T> scaled = scale * e[i];
      const T length = Sqrt(Select(none, T(1.0), Dot(scaled, scaled)));
      e[i] = (T(1.0) / length) * scaled;
      inverse[i] = scale / length;
      length_is_zero = Select(none, T(1.0), length_is_zero);
    }
    f.t0 = e[0];
    f.t1 = e[1];
    f.inverse0 = inverse[0];
    f.inverse1 = inverse[1];
    const Vec3<T> c = Cross(f.t0, f.t1);
    const T sine2 = Dot(c, c);
    f.outside = (sine2 <= T(kTau * kTau)) | (length_is_zero > T(0.0));
    const T sine = Sqrt(Select(f.outside, T(1.0), sine2));
    f.n = (T(1.0) / sine) * c;
    f.b0 = Cross(f.t0, f.n);
    f.b1 = Cross(f.t1, f.n);
    const T cosine = Dot(f.t0, f.t1);
    f.omega = Atan2(sine, -cosine);
    // tan(theta/2) = sin/(1 + cos) = (1 - cos)/sin: the one that does not cancel.
    const T larger = (T(1.0) + Abs(cosine)) / sine, smaller = sine / (T(1.0) + Abs(cosine));
    const auto acute = cosine > T(0.0);
    f.tan_half = Select(acute, smaller, larger);
    f.cot_half = Select(acute, larger, smaller);
    return f;
  }

  // f1 = psi'(theta), zero outside.
  template <class T>
  static DEFINITE_INLINE T Slope(const Frame<T>& f, const Vec<T, 2>& p) {
    return Select(f.outside, T(0.0), p[0] * (p[1] - f.omega));
  }

  // (u / |e0|; v / |e1|) from the edges to the vertices.
  template <class T>
  static DEFINITE_INLINE Vec<T, 9> PullBack(const Frame<T>& f, const Vec3<T>& u, const Vec3<T>& v) {
    Vec<T, 9> r;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const T a = f.inverse0 * u[i], b = f.inverse1 * v[i];
      r[i] = a;
      r[3 + i] = -(a + b);
      r[6 + i] = b;
    }
    return r;
  }
};

DEFINITE_ENERGY(StrandBend);

}  // namespace definite
