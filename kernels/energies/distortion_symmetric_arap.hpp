#pragma once

// Symmetric as rigid as possible: psi = mu/2 sum (s_i - 1)^2 (1 + s_i^-2).
//
// Source: Smith, de Goes and Kim 2019, appendix F.2. Parameters: mu (energy).

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct SymmetricArap {
  static constexpr std::string_view kName = "symmetric_arap";
  static constexpr std::string_view kSource = "Smith et al. 2019, appendix F.2";
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, "stiffness, times the rest volume"}};
  static constexpr Stretchable kDomain = Stretchable::kNotInverted;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    return T(0.5) * p[0] * Sum(Each(s, [](const T& si) {
             const T x = si - T(1.0), u = T(1.0) / si;
             return x * x * MulAdd(u, u, T(1.0));
           }));
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    // s - 1 - s^-3 + s^-2 = (s - 1)(1 + s^-3)
    return Each(s, [p](const T& si) {
      const T u = T(1.0) / si;
      return p[0] * (si - T(1.0)) * MulAdd(u * u, u, T(1.0));
    });
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    const T u = T(1.0) / pair.j, v = T(1.0) / pair.k, w = u * v;
    const T squares = MulAdd(u, u, v * v);
    return p[0] * (T(1.0) - w * (squares - w) + (squares - T(2.0)) / (pair.j + pair.k));
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    const T u = T(1.0) / pair.j, v = T(1.0) / pair.k, w = u * v;
    return p[0] * (T(1.0) + w * (MulAdd(u, u, v * v) + w) - w * (u + v));
  }
  template <class T, int D>
  static Vec<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    return Each(s, [p](const T& si) {
      const T u = T(1.0) / si, cube = u * u * u;
      return p[0] * (T(1.0) + cube * (T(3.0) * u - T(2.0)));
    });
  }
};

DEFINITE_ENERGY(Distortion<Triangle, SymmetricArap>);
DEFINITE_ENERGY(Distortion<Tetrahedron, SymmetricArap>);

}  // namespace definite
