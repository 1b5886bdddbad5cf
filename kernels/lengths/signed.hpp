#pragma once

// The signed length l = side (n . e2), n = e0 x e1 / |e0 x e1|, and the modes of psi(l).
//
// Source: Shi & Kim 2023, Eqs. 1-13 and 16-19.
// Differs: no e2perp and no division by l. The 2x2 block of each of the two mode pairs is
//   psi' [[-l/len^2, -1/len], [-1/len, 0]]  on (n in slot i, t_i in slot 2),
// with eigenvectors (tau, 1) and (-1/tau, 1), tau = r + h, h = sqrt(1 + r^2), r = l/(2 len); scaled
// so, their weights are -psi'/(2 h len) and +psi'/(2 h len). beta and gamma come
// from the in-plane dual basis, since the printed quotients cancel like 1/sin^2. Lengths are taken
// in units of a power of two near the largest edge component, so nothing overflows on the way.
// Shapes and units: x in any unit of length; weights of psi; alpha, beta, gamma, w free of units.
// Domain: sin(e0, e1) > kTau, and |e0 x e1| > 2^-450 (largest edge component)^2: beyond that the
// Hessian is not representable. Outside it everything is zero.

#include <utility>

#include "kernels/kernel.hpp"

namespace definite {

// The relative threshold under which a configuration is out of domain; a constant of the protocol.
inline constexpr double kTau = 1e-8;

template <class Stencil>
struct SignedLength {
  static constexpr std::string_view kName = "signed";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 1, 8-13, 16-19";
  static constexpr int kDofs = Stencil::kDofs;

  template <class T>
  using Outside = decltype(std::declval<T>() <= std::declval<T>());  // bool, or a mask over lanes

  // The collision frame of one configuration.
  template <class T>
  struct Frame {
    T scale, lift;           // lengths below are in units of 1 / (scale lift)
    Outside<T> outside;      // not in the domain; the rest is then finite and meaningless
    T l;                     // signed length
    Vec3<T> n;               // unit normal, such that l = n . e2
    Vec3<T> t0, t1;          // unit tangents along e0 and e1 - alpha e0
    T inverse_a, inverse_b;  // 1/|e0| and 1/|e1 - alpha e0|
    T alpha;
    Vec<T, 4> w;  // grad l = w (x) n; for a vertex and a face (1, -barycentric coordinates)

    T InUnits(const T& length) const { return length * lift * scale; }
  };

  template <class T>
  static DEFINITE_INLINE Frame<T> FrameOf(const Vec<T, kDofs>& x, const T& side) {
    auto [e0, e1, e2] = Stencil::EdgesOf(x);
    T largest[3];  // of each coordinate; a chain of nine would be the longest path of the kernel
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) largest[i] = Max(Max(Abs(e0[i]), Abs(e1[i])), Abs(e2[i]));
    const T magnitude = Max(Max(largest[0], largest[1]), largest[2]);
    Frame<T> f;
    // Subnormal lengths are lifted first: they have no exponent to read.
    constexpr double kSmallestNormal = 0x1p-1022;
    f.lift = Select(magnitude < T(kSmallestNormal), T(0x1p54), T(1.0));
    f.scale = InversePowerOfTwo(Max(magnitude * f.lift, T(kSmallestNormal)));
#pragma GCC unroll 16
    for (Vec3<T>* e : {&e0, &e1, &e2}) *e = f.scale * (f.lift * *e);

    const Vec3<T> c = Cross(e0, e1);
    T area2 = Dot(c, c), aa = Dot(e0, e0);
    f.outside = area2 <= Max(T(kTau * kTau) * (aa * Dot(e1, e1)), T(0x1p-900));
    area2 = Select(f.outside, T(1.0), area2);
    aa = Select(f.outside, T(1.0), aa);

    const T area = Sqrt(area2), a = Sqrt(aa);
    const T inverse_area = T(1.0) / area;
    f.inverse_a = T(1.0) / a;
    f.inverse_b = a * inverse_area;
    const Vec3<T> normal = inverse_area * c;
    f.t0 = f.inverse_a * e0;
    f.t1 = Cross(normal, f.t0);
    f.alpha = Dot(f.t0, e1) * f.inverse_a;
    // The in-plane dual basis: d0 . e0 = 1, d0 . e1 = 0, d1 . e0 = 0, d1 . e1 = 1.
    const T beta = Dot(Cross(e1, normal), e2) * inverse_area;
    const T gamma = Dot(Cross(normal, e0), e2) * inverse_area;
    f.w = Stencil::Row2(beta, gamma);
    f.n = Select(side < T(0.0), T(-1.0), T(1.0)) * normal;
    f.l = Dot(f.n, e2);
    return f;
  }

  // The modes of psi(l) in the frame, pulled back to x. psi1 = psi'/unit, psi2 = psi''.
  template <Part kPart, class T>
  static DEFINITE_INLINE auto FrameModes(const Frame<T>& f, const T& psi1, const T& psi2) {
    constexpr int kCount = kPart == Part::kCurvature ? 1 : kPart == Part::kPositive ? 3 : 5;
    Modes<T, kDofs, kCount> modes;
    modes.lambda[0] = psi2;
    modes.v[0] = Kron(f.w, f.n);  // g_l pulled back, Eqs. 13 and 57
    if constexpr (kPart != Part::kCurvature) {
      const Vec<T, 4> rows[2] = {Stencil::template Row0<T>(), Stencil::Row1(f.alpha)};
      const Vec3<T> tangents[2] = {f.t0, f.t1};
      const T inverse_lengths[2] = {f.inverse_a, f.inverse_b};
#pragma GCC unroll 16
      for (int i = 0; i < 2; ++i) {
        const T half = T(0.5) * inverse_lengths[i];
        const T r = f.l * half;
        const T h = Sqrt(MulAdd(r, r, T(1.0)));
        const T larger = h + Abs(r);
        const T inverse = T(1.0) / (h * larger);
        const T smaller = inverse * h;  // h - |r| without cancellation
        const T weight = psi1 * half * (inverse * larger);
        const T tau = Select(r < T(0.0), smaller, larger);
        const Vec<T, kDofs> tangential = Kron(f.w, tangents[i]);
        // psi' <= 0 on a penalty's active set: this one is kept (Eqs. 11, 12).
        modes.lambda[1 + i] = -weight;
        modes.v[1 + i] = AddKron(tangential, tau * rows[i], f.n);
        if constexpr (kPart == Part::kAll) {
          const T minus_inverse_tau = -Select(r < T(0.0), larger, smaller);
          modes.lambda[3 + i] = weight;
          modes.v[3 + i] = AddKron(tangential, minus_inverse_tau * rows[i], f.n);
        }
      }
    }
    return modes;
  }

  // Signed length and frame as printed: be, ga by the printed quotients, no common unit of length.
  template <class T>
  struct PrintedFrame {
    T l;
    Vec3<T> c0, c1, c2;    // e0perp, e1perp, e2perp: the columns of C, Eq. 2
    Vec<T, 4> s0, s1, s2;  // rows of the frame map, Eq. 19
  };

  template <class T>
  static DEFINITE_INLINE PrintedFrame<T> PrintedFrameOf(const Vec<T, kDofs>& x, const T& side) {
    const auto [e0, e1, e2] = Stencil::EdgesOf(x);
    const Vec3<T> c = Cross(e0, e1);
    PrintedFrame<T> f;
    f.l = Select(side < T(0.0), T(-1.0), T(1.0)) * (Dot(e2, c) / Sqrt(Dot(c, c)));  // Eq. 1
    const T d00 = Dot(e0, e0), d01 = Dot(e0, e1), d11 = Dot(e1, e1);
    const T d02 = Dot(e0, e2), d12 = Dot(e1, e2);
    const T determinant = d00 * d11 - d01 * d01;
    const T alpha = d01 / d00;
    const T beta = (d11 * d02 - d01 * d12) / determinant;
    const T gamma = (d00 * d12 - d01 * d02) / determinant;
    f.c0 = e0;
    f.c1 = e1 - alpha * e0;
    f.c2 = (e2 - beta * e0) - gamma * e1;
    f.s0 = Stencil::template Row0<T>();
    f.s1 = Stencil::Row1(alpha);
    f.s2 = Stencil::Row2(beta, gamma);
    return f;
  }

  // The modes by Eqs. 8-13 as printed, eigenvectors normalised, pulled back by Eq. 19.
  template <class T>
  static DEFINITE_INLINE Modes<T, kDofs, 5> PrintedModes(const PrintedFrame<T>& f, const T& psi1,
                                                         const T& psi2) {
    Modes<T, kDofs, 5> modes;
    const T c22 = Dot(f.c2, f.c2), c2_length = Sqrt(c22);
    modes.lambda[0] = psi2;
    // Erratum: the display after Eq. 10 prints g_l with six entries; Eq. 57 has the nine.
    modes.v[0] = Kron(f.s2, (f.l / c22) * f.c2);
    const Vec<T, 4> rows[2] = {f.s0, f.s1};
    const Vec3<T> edges[2] = {f.c0, f.c1};
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      const T cii = Dot(edges[i], edges[i]);
      const T ratio = Sqrt(cii) / c2_length;
      const T f_i2 = Sqrt(T(1.0) + T(4.0) * (ratio * ratio));  // f(i, 2), Eq. 10
#pragma GCC unroll 2
      for (int sign = 0; sign < 2; ++sign) {
        const T lambda =
            -f.l / (T(2.0) * cii) * (sign == 0 ? T(1.0) + f_i2 : T(1.0) - f_i2);  // Eqs. 8, 9
        const T omega = lambda / (lambda - f.l / c22);                            // Eq. 10
        const T norm = Sqrt(c22 + omega * omega * cii);
        const Vec<T, kDofs> q = AddKron(Kron(f.s2, omega * edges[i]), rows[i], f.c2);
        modes.lambda[1 + 2 * i + sign] = psi1 * lambda;  // Eqs. 11, 12
        modes.v[1 + 2 * i + sign] = (T(1.0) / norm) * q;
      }
    }
    return modes;
  }
};

}  // namespace definite
