#pragma once

// Stretching of a strand, psi = k/2 (|x1 - x0| - length)^2: a linear spring.
//
// Source: textbook; with d the unit vector along the spring and len its length, the Hessian over
// the edge is k d d^T + k (1 - length/len) (I - d d^T): indefinite where the spring is shorter than
// at rest.
// Differs: 1 - length/len as (len - length)/len, which does not cancel near rest.
// Parameters: k (energy over a length squared), length (at rest).
// Domain: longer than kLeastSpring (in any unit). Always active.

#include <string>

#include "kernels/lengths/collision_frame.hpp"
#include "kernels/registry.hpp"
#include "kernels/stencils/segment.hpp"

namespace definite {

inline constexpr double kLeastSpring = 0x1p-1022;  // of any unit: shorter ones are subnormal

struct StrandStretch {
  using Stencil = Segment;
  static constexpr int kDofs = 6, kParams = 2;
  static constexpr Parameter kParameters[] = {
      {"k", 1.0, 0, "stiffness"},
      {"length", 1.0, 1, "length at rest"},
  };

  static std::string Name() { return "strand/stretch/quadratic"; }
  static std::string Source() { return "linear spring; Shi & Kim 2023, section 5.2.1, uses such"; }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T stretch = f.length - p[1];
    return Select(f.outside, T(0.0), T(0.5) * p[0] * stretch * stretch);
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, 6> Gradient(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    return Select(f.outside, T(0.0), p[0] * (f.length - p[1])) * Ends(f.d);
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, 6>& x, const Vec<T, 2>&) {
    const T inside = Select(FrameOf(x).outside, T(0.0), T(1.0));
    return {inside, inside, T(0.0)};
  }

  template <Set kSet, Part kPart, class T>
  requires(kSet == Set::kFrame || kSet == Set::kExact) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const Frame<T> f = FrameOf(x);
    const T k = Select(f.outside, T(0.0), p[0]);
    if constexpr (kPart == Part::kCurvature) {
      return Modes<T, 6, 1>{{k}, {Ends(f.d)}};
    } else {
      const Vec3<T> axis = AxisOff(f.d), off = axis - Dot(axis, f.d) * f.d;
      const Vec3<T> t0 = (T(1.0) / Sqrt(Dot(off, off))) * off, t1 = Cross(f.d, t0);
      const T across = k * ((f.length - p[1]) / f.length);
      return Modes<T, 6, 3>{{k, across, across}, {Ends(f.d), Ends(t0), Ends(t1)}};
    }
  }

 private:
  template <class T>
  struct Frame {
    MaskOf<T> outside;
    Vec3<T> d;  // unit vector from x0 to x1
    T length;   // 1 outside
  };

  template <class T>
  static DEFINITE_INLINE Frame<T> FrameOf(const Vec<T, 6>& x) {
    const Vec3<T> e = Vertex(x, 1) - Vertex(x, 0);
    // A power of two keeps the squares in range.
    const T magnitude = Max(Max(Abs(e[0]), Abs(e[1])), Abs(e[2]));
    Frame<T> f;
    f.outside = magnitude < T(kLeastSpring);
    const T scale = Select(f.outside, T(1.0), InversePowerOfTwo(Max(magnitude, T(kLeastSpring))));
    const Vec3<T> along_x = {T(1.0), T(0.0), T(0.0)};
    const Vec3<T> scaled = SelectAll(f.outside, along_x, scale * e);
    const T length = Sqrt(Dot(scaled, scaled));
    f.d = (T(1.0) / length) * scaled;
    f.length = length / scale;
    return f;
  }

  // v on the edge x1 - x0.
  template <class T>
  static DEFINITE_INLINE Vec<T, 6> Ends(const Vec3<T>& v) {
    return {-v[0], -v[1], -v[2], v[0], v[1], v[2]};
  }
};

DEFINITE_ENERGY(StrandStretch);

}  // namespace definite
