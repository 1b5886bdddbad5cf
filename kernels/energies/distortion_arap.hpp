#pragma once

// As rigid as possible: psi = mu sum (s_i - 1)^2 = mu |F - R|^2.
//
// Source: Smith, de Goes and Kim 2019, section 5.1 and Eqs. 21 to 27. Parameters: mu (energy).

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct Arap {
  static constexpr std::string_view kName = "arap";
  static constexpr std::string_view kSource = "Smith et al. 2019, section 5.1";
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, "stiffness, times the rest volume"}};
  static constexpr Stretchable kDomain = Stretchable::kWithRotation;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> x = Each(s, [](const T& si) { return si - T(1.0); });
    return p[0] * Dot(x, x);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    return Each(s, [p](const T& si) { return T(2.0) * p[0] * (si - T(1.0)); });
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    return T(2.0) * p[0] * Turning(pair);
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>&, const StretchPair<T>&, const T* p) {
    return T(2.0) * p[0];
  }
  template <class T, int D>
  static Vec<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    return Each(s, [p](const T&) { return T(2.0) * p[0]; });
  }

  // Gauss-Newton of the residual F - R.
  template <class T, int D>
  static Vec<T, D> ScalingCurvature(const Vec<T, D>& s, const T* p) {
    return Scaling(s, p);
  }
  template <class T, int D>
  static Modes<T, 2, 2> PairCurvature(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    const T turning = Turning(pair);
    return {{p[0] * turning * turning, p[0]}, {{T(-1.0), T(1.0)}, {T(1.0), T(1.0)}}};
  }

  // 1 - 2/(s_j + s_k): how much of a turn of F the rotation R does not follow.
  template <class T>
  static T Turning(const StretchPair<T>& pair) {
    return ((pair.j - T(1.0)) + (pair.k - T(1.0))) / (pair.j + pair.k);
  }
};

template <>
inline constexpr bool kStudied<Distortion<Tetrahedron, Arap>> = true;

DEFINITE_ENERGY(Distortion<Triangle, Arap>);
DEFINITE_ENERGY(Distortion<Tetrahedron, Arap>);

}  // namespace definite
