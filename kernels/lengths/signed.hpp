#pragma once

// The signed length l = side (n . e2), n = e0 x e1 / |e0 x e1|.
//
// Source: Shi & Kim 2023, Eqs. 1-13 and 16-19.
// Differs: collision_frame.hpp.
// Domain: sin(e0, e1) > kTau, and both edges longer than kLeastEdge. Outside it everything is zero.

#include "kernels/lengths/collision_frame.hpp"

namespace definite {

// -1 where side is negative, else 1: 0 counts as positive.
template <class T>
DEFINITE_INLINE T Orientation(const T& side) {
  return Select(side < T(0.0), T(-1.0), T(1.0));
}

template <class Primitive>
struct Signed {
  using Stencil = Primitive;
  static constexpr std::string_view kName = "signed";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 1, 8-13, 16-19";
  static constexpr std::string_view kSide =
      "sign of the length: -1 flips it, +1 and 0 keep the triple product's";
  static constexpr Tangents kTangents = kBothFree;

  template <class T>
  static DEFINITE_INLINE CollisionFrame<T, Stencil, 2> FrameOf(const Vec<T, 12>& x, const T& side) {
    CollisionFrame<T, Stencil, 2> f;
    Edges<T> edges = Stencil::EdgesOf(x);
    Prescale(f, edges);
    const Plane<T> plane = PlaneOf(edges);
    SetPlane<Stencil>(plane, edges, Orientation(side), f);
    f.outside = plane.parallel;
    return f;
  }

  // Signed length and frame as printed: beta and gamma by the printed quotients, no common unit of
  // length.
  template <class T>
  struct PrintedFrame {
    T l;
    Vec3<T> c0, c1, c2;    // e0perp, e1perp, e2perp: the columns of C, Eq. 2
    Vec<T, 4> s0, s1, s2;  // rows of the frame map over the vertices, Eq. 19
  };

  template <class T>
  static DEFINITE_INLINE PrintedFrame<T> PrintedFrameOf(const Vec<T, 12>& x, const T& side) {
    const auto [e0, e1, e2] = Stencil::EdgesOf(x);
    const Vec3<T> c = Cross(e0, e1);
    PrintedFrame<T> f;
    f.l = Orientation(side) * (Dot(e2, c) / Sqrt(Dot(c, c)));  // Eq. 1
    const T d00 = Dot(e0, e0), d01 = Dot(e0, e1), d11 = Dot(e1, e1);
    const T d02 = Dot(e0, e2), d12 = Dot(e1, e2);
    const T determinant = d00 * d11 - d01 * d01;
    const T alpha = d01 / d00;
    const T beta = (d11 * d02 - d01 * d12) / determinant;
    const T gamma = (d00 * d12 - d01 * d02) / determinant;
    f.c0 = e0;
    f.c1 = e1 - alpha * e0;
    f.c2 = (e2 - beta * e0) - gamma * e1;
    const PlaneRows<T> rows = PlaneRowsOf(alpha, beta, gamma);
    f.s0 = OverVertices<Stencil>(rows.c0);
    f.s1 = OverVertices<Stencil>(rows.c1);
    f.s2 = OverVertices<Stencil>(rows.c2);
    return f;
  }

  // The modes by Eqs. 8-13 as printed, eigenvectors normalised, pulled back by Eq. 19.
  template <class T>
  static DEFINITE_INLINE Modes<T, 12, 5> PrintedModes(const PrintedFrame<T>& f, const T& psi1,
                                                      const T& psi2) {
    Modes<T, 12, 5> modes;
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
        const Vec<T, 12> q = AddKron(Kron(f.s2, omega * edges[i]), rows[i], f.c2);
        modes.lambda[1 + 2 * i + sign] = psi1 * lambda;  // Eqs. 11, 12
        modes.v[1 + 2 * i + sign] = (T(1.0) / norm) * q;
      }
    }
    return modes;
  }
};

}  // namespace definite
