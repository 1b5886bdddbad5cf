#pragma once

// Twisting of a strand, psi = mu/2 (tau - tau0)^2, tau the angle from its first edge to its last
// about the middle one; the difference is taken the short way round, within (-pi, pi].
//
// Source: Shi et al. 2023, Lifted Curls, supplement, section 2, corrected.
// Differs: tau by atan2, which is smooth through 0 and pi; natural coordinates in place of the
// projected edges, whose Hessian grows without bound where the strand is flat, along a motion that
// twists nothing: four 2x2 blocks, each decomposed in closed form (docs/derivations.md, section 5).
// Sign: tau > 0 where e0, e1, e2 are a right-handed screw, e1.(e0 x e2) > 0; who has the other sign
// turns tau0 around too.
// Parameters: mu (energy), tau0 (radians, within [-pi, pi]).
// Domain: all edges longer than kLeastStrandEdge (in any unit), and the sines between e1 and its
// neighbours above 1e-8. Always active.

#include <numbers>
#include <string>

#include "kernels/core/jacobi.hpp"
#include "kernels/core/precision.hpp"
#include "kernels/core/transcendental.hpp"
#include "kernels/energies/strand_bend.hpp"
#include "kernels/registry.hpp"
#include "kernels/stencils/torsion.hpp"

namespace definite {

struct StrandTwist {
  using Stencil = Torsion;
  static constexpr int kDofs = 12, kParams = 2;
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness, an energy"},
      {"tau0", 0.5, 0, "twist at rest, in radians, within [-pi, pi]"},
  };

  static std::string Name() { return "strand/twist/quadratic"; }
  static std::string Source() {
    return "Shi et al. 2023 (Lifted Curls), supplement, section 2, corrected";
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, 12>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T d = Untwisted(f, p);
    return Select(f.outside, T(0.0), T(0.5) * p[0] * d * d);
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, 12> Gradient(const Vec<T, 12>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    return Select(f.outside, T(0.0), p[0] * Untwisted(f, p)) * TwistOf(f);
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, 12>& x, const Vec<T, 2>&) {
    const T inside = Select(FrameOf(x).outside, T(0.0), T(1.0));
    return {inside, inside, T(0.0)};
  }

  template <Set kSet, Part kPart, class T>
  requires(kSet == Set::kFrame || kSet == Set::kExact) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, 12>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T mu = Select(f.outside, T(0.0), p[0]);
    if constexpr (kPart == Part::kCurvature) {
      return Modes<T, 12, 1>{{mu}, {TwistOf(f)}};
    } else {
      // In units of mu, which may be far from 1: eigenvalues of a block square its entries.
      const T slope = Select(f.outside, T(0.0), Untwisted(f, p)), f1 = mu * slope;
      const T none = T(0.0), half = T(0.5), root2 = ConstantRoot<T>::Of(2);
      // In the plane of each neighbour: how much of it is stretched (r) and turned about e1 (q).
      const Vec<T, 12> r0 = OnFirst(f, f.a), q0 = OnFirst(f, f.p0);
      const Vec<T, 12> r2 = OnLast(f, f.b), q2 = OnLast(f, f.p1);
      Modes<T, 12, 8> modes;
      // The halves are the squares of 1/sqrt 2.
      const auto turned = SymmetricEigen2(none, -slope, T(2.0));
      SetBlock(modes, 0, half * mu, turned, r0 + r2, q2 - q0);
      const auto stretched = SymmetricEigen2(none, T(-1.0), none);
      SetBlock(modes, 2, half * f1, stretched, r2 - r0, q0 + q2);
      // Out of these planes: how e1 leans, along the bisectors m and h of its neighbours, and how
      // their feet slide on it.
      const Vec3<T> m = f.cos_half * f.a + f.sin_half * f.p0,
                    h = f.cos_half * f.p0 - f.sin_half * f.a;
      const Vec<T, 12> d0 = OnFirst(f, f.k) + OnMiddle(f, f.a),
                       d2 = OnLast(f, f.k) + OnMiddle(f, f.b);
      const T sine = T(2.0) * f.sin_half * f.cos_half;
      const T scale = ConstantRoot<T>::Of(2) / T(2.0);
      const auto leans_m = SymmetricEigen2(-sine, root2 * f.sin_half, none);
      SetBlock(modes, 4, f1, leans_m, OnMiddle(f, m), scale * (d0 + d2));
      const auto leans_h = SymmetricEigen2(sine, root2 * f.cos_half, none);
      SetBlock(modes, 6, f1, leans_h, OnMiddle(f, h), scale * (d0 - d2));
      return modes;
    }
  }

  template <class T>
  static auto Nearest(const Vec<T, 12>& x, const Vec<T, 2>& p) {
    return NearestPsdOfFour(HessianModes<Set::kExact, Part::kAll>(x, p));
  }

 private:
  template <class T>
  struct Frame {
    MaskOf<T> outside;
    Vec3<T> k, a, b, p0, p1;  // e1; the parts of e0 and e2 normal to it; k x a, k x b: all unit
    T alpha, beta;            // e0.e1/|e1|^2, e2.e1/|e1|^2
    T inverse0, inverse1, inverse2;  // one over the length of the part of e0, of e1, of that of e2
    T tau, sin_half, cos_half;
  };

  template <class T>
  static DEFINITE_INLINE Frame<T> FrameOf(const Vec<T, 12>& x) {
    const Vec3<T> x1 = Vertex(x, 1), x2 = Vertex(x, 2);
    Vec3<T> e[3] = {Vertex(x, 0) - x1, x2 - x1, Vertex(x, 3) - x2};
    T inverse[3], length[3];
    T too_short = T(0.0);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      // A power of two keeps the squares in range.
      const T magnitude = Max(Max(Abs(e[i][0]), Abs(e[i][1])), Abs(e[i][2]));
      const auto none = magnitude <= T(kLeastStrandEdge);
      const T scale = Select(none, T(1.0), InversePowerOfTwo(Max(magnitude, T(kLeastStrandEdge))));
      const Vec3<T> scaled = scale * e[i];
      const T root = Sqrt(Select(none, T(1.0), Dot(scaled, scaled)));
      e[i] = (T(1.0) / root) * scaled;
      inverse[i] = scale / root;
      length[i] = root / scale;
      too_short = Select(none, T(1.0), too_short);
    }
    Frame<T> f;
    f.k = e[1];
    const Vec3<T> c0 = CarefulCross(f.k, e[0]), c1 = CarefulCross(f.k, e[2]);
    const T sine0 = Dot(c0, c0), sine1 = Dot(c1, c1);
    f.outside = (sine0 <= T(kTau * kTau)) | (sine1 <= T(kTau * kTau)) | (too_short > T(0.0));
    const T one0 = T(1.0) / Sqrt(Select(f.outside, T(1.0), sine0));
    const T one1 = T(1.0) / Sqrt(Select(f.outside, T(1.0), sine1));
    f.p0 = one0 * c0;
    f.p1 = one1 * c1;
    f.a = Cross(f.p0, f.k);
    f.b = Cross(f.p1, f.k);
    f.alpha = Dot(e[0], f.k) * length[0] * inverse[1];
    f.beta = Dot(e[2], f.k) * length[2] * inverse[1];
    f.inverse0 = one0 * inverse[0];
    f.inverse1 = inverse[1];
    f.inverse2 = one1 * inverse[2];
    const T cosine = Dot(f.p0, f.p1), sine = Dot(Cross(f.p0, f.p1), f.k);
    f.tau = Atan2(sine, cosine);
    // The half whose square does not cancel, and the other by the sine.
    const auto acute = cosine > T(0.0);
    const T larger = Sqrt(T(0.5) * (T(1.0) + Abs(cosine)));
    const T smaller = T(0.5) * sine / larger;
    f.cos_half = Select(acute, larger, Abs(smaller));
    f.sin_half = Select(acute, smaller, Select(sine < T(0.0), -larger, larger));
    return f;
  }

  // tau - tau0, the short way round.
  template <class T>
  static DEFINITE_INLINE T Untwisted(const Frame<T>& f, const Vec<T, 2>& p) {
    const T pi = T(std::numbers::pi), turn = T(2.0) * pi, d = f.tau - p[1];
    return Select(d > pi, d - turn, Select(d <= -pi, d + turn, d));
  }

  // The gradient of tau.
  template <class T>
  static DEFINITE_INLINE Vec<T, 12> TwistOf(const Frame<T>& f) {
    return OnLast(f, f.p1) - OnFirst(f, f.p0);
  }

  // v on the part of e0 normal to e1, in its lengths, its foot held on e1; the same of e2; and v on
  // e1 in its lengths.
  template <class T>
  static DEFINITE_INLINE Vec<T, 12> OnFirst(const Frame<T>& f, const Vec3<T>& v) {
    const Vec<T, 4> row = {f.inverse0, f.inverse0 * (f.alpha - T(1.0)), -(f.inverse0 * f.alpha),
                           T(0.0)};
    return Kron(row, v);
  }
  template <class T>
  static DEFINITE_INLINE Vec<T, 12> OnLast(const Frame<T>& f, const Vec3<T>& v) {
    const Vec<T, 4> row = {T(0.0), f.inverse2 * f.beta, -(f.inverse2 * (f.beta + T(1.0))),
                           f.inverse2};
    return Kron(row, v);
  }
  template <class T>
  static DEFINITE_INLINE Vec<T, 12> OnMiddle(const Frame<T>& f, const Vec3<T>& v) {
    const Vec<T, 4> row = {T(0.0), -f.inverse1, f.inverse1, T(0.0)};
    return Kron(row, v);
  }

  // weight times a 2x2 matrix over the functionals u and v, in its eigenpairs.
  template <class T>
  static DEFINITE_INLINE void SetBlock(Modes<T, 12, 8>& modes, int at, const T& weight,
                                       const Eigen2<T>& e, const Vec<T, 12>& u,
                                       const Vec<T, 12>& v) {
    modes.lambda[at] = weight * e.first;
    modes.v[at] = e.c * u + e.s * v;
    modes.lambda[at + 1] = weight * e.second;
    modes.v[at + 1] = e.c * v - e.s * u;
  }
};

DEFINITE_ENERGY(StrandTwist);

}  // namespace definite
