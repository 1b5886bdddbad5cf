#pragma once

// The distance u of a vertex to the plane of a face, with a sign s of its own: l = s u.
//
// Source: Shi & Kim 2023, Eqs. 17, 20, 25, 41-52.
// Differs: Eq. 25 with the right activation test. The exact Hessian is that of the signed length
// whose normal points so that l = n . e2, and is taken from there; the paper's two terms of Eq. 17
// make the frame set, psi'/l [(w (x) t_i)^2 - (w (x) t_i + (l/len_i) S_i (x) n)^2], whose sum
// cancels as u -> 0 and whose clamp grows without bound.
// Domain: as for the signed length, and u above kLeastLength.

#include "kernels/lengths/signed.hpp"

namespace definite {

// The sign of an unsigned length: +1 outside, -1 penetrating; 0 takes the triple product's.
template <class T>
DEFINITE_INLINE T SideOrSignOf(const T& side, const T& triple) {
  return Select(side < T(0.0), T(-1.0),
                Select(side > T(0.0), T(1.0), Select(triple < T(0.0), T(-1.0), T(1.0))));
}

template <class Primitive>
struct UnsignedPlane {
  using Stencil = Primitive;
  static constexpr std::string_view kName = "unsigned";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 16, 17, 20, 25, 51, 52";
  static constexpr std::string_view kSide =
      "+1 outside, -1 penetrating, 0 by the sign of the triple product";
  static constexpr Tangents kTangents = kBothFree;

  template <class T>
  static DEFINITE_INLINE CollisionFrame<T, Stencil, 2> FrameOf(const Vec<T, 12>& x, const T& side) {
    CollisionFrame<T, Stencil, 2> f;
    Edges<T> edges = Stencil::EdgesOf(x);
    Prescale(f, edges);
    const Plane<T> plane = PlaneOf(edges);
    const T triple = Dot(plane.normal, edges.e2);
    const T sign = Select(triple < T(0.0), T(-1.0), T(1.0));
    SetPlane<Stencil>(plane, edges, SideOrSignOf(side, triple) * sign, f);
    const auto on_plane = Abs(f.l) <= T(kLeastLength);
    f.outside = plane.parallel | on_plane;
    f.l = Select(on_plane, T(1.0), f.l);
    return f;
  }

  // The frame set: psi'', then what each tangent keeps and drops.
  template <Part kPart, class T>
  static DEFINITE_INLINE auto SplitModes(const CollisionFrame<T, Stencil, 2>& f, const T& psi1,
                                         const T& psi2) {
    constexpr int kCount = kPart == Part::kCurvature ? 1 : kPart == Part::kPositive ? 3 : 5;
    FrameModes<T, kCount, kPart != Part::kCurvature> modes;
    modes.mode[0] = {psi2, -1, T(0.0), f.n};
    if constexpr (kPart != Part::kCurvature) {
      const T slide = psi1 / f.l;  // Eq. 52; of w (x) t, and minus it of the second term
      const auto outside = slide < T(0.0);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        const T turn = f.l * f.inverse_length[i];
        modes.mode[1 + i] = {Abs(slide), i, Select(outside, turn, T(0.0)), f.t[i]};
        if constexpr (kPart == Part::kAll) {
          modes.mode[3 + i] = {-Abs(slide), i, Select(outside, T(0.0), turn), f.t[i]};
        }
      }
    }
    return modes;
  }

  // D = dc/dx - S, Eq. 20: how the frame weights change. Free of units; zero outside the domain.
  template <class T>
  static void Remainder(const Vec<T, 12>& x, const MaskOf<T>& outside, T (&d)[9][12]) {
    CollisionFrame<T, Stencil, 2> unit;
    Edges<T> edges = Stencil::EdgesOf(x);
    Prescale(unit, edges);
    const auto& [e0, e1, e2] = edges;
    const T a2 = Dot(e0, e0), al = Dot(e0, e1) / a2;
    const Vec3<T> c1 = e1 - al * e0;
    const T b2 = Dot(c1, c1);
    const T ga = Dot(c1, e2) / b2, be = (Dot(e0, e2) - ga * Dot(e0, e1)) / a2;
    const Vec3<T> c2 = (e2 - be * e0) - ga * e1;
    const PlaneRows<T> rows = PlaneRowsOf(al, be, ga);
    const Vec<T, 4> s0 = OverVertices<Stencil>(rows.c0), s1 = OverVertices<Stencil>(rows.c1),
                    s2 = OverVertices<Stencil>(rows.c2);
    const Vec<T, 12> al_x = (T(1.0) / a2) * (Kron(s0, c1) + Kron(s1, e0));
    const Vec<T, 12> ga_x = (T(1.0) / b2) * (Kron(s1, c2) + Kron(s2, c1));
    const Vec<T, 12> be_x = (T(1.0) / a2) * (Kron(s0, c2) + Kron(s2, e0)) - al * ga_x;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 12; ++j) {
        d[i][j] = T(0.0);
        d[3 + i][j] = Select(outside, T(0.0), -(e0[i] * al_x[j]));
        d[6 + i][j] = Select(outside, T(0.0), -(e0[i] * be_x[j] + e1[i] * ga_x[j]));
      }
    }
  }
};

}  // namespace definite
