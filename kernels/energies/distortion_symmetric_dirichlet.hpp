#pragma once

// Symmetric Dirichlet: psi = mu/2 (|F|^2 + |F^-1|^2) - mu d, which is 0 at rest.
//
// Source: Smith, de Goes and Kim 2019, section 5.2 and Eqs. 28 to 34. Parameters: mu (energy).

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct SymmetricDirichlet {
  static constexpr std::string_view kName = "symmetric_dirichlet";
  static constexpr std::string_view kSource = "Smith et al. 2019, section 5.2";
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, "stiffness, times the rest volume"}};
  static constexpr Stretchable kDomain = Stretchable::kNotInverted;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> x = Each(s, [](const T& si) { return (si - T(1.0)) * (si + T(1.0)) / si; });
    return T(0.5) * p[0] * Dot(x, x);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    // s - s^-3
    return Each(s, [p](const T& si) {
      const T square = si * si;
      return p[0] * ((square - T(1.0)) * (square + T(1.0))) / (square * si);
    });
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    const T u = T(1.0) / pair.j, v = T(1.0) / pair.k, w = u * v;
    return p[0] * (T(1.0) - w * (MulAdd(u, u, v * v) - w));
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    const T u = T(1.0) / pair.j, v = T(1.0) / pair.k, w = u * v;
    return p[0] * (T(1.0) + w * (MulAdd(u, u, v * v) + w));
  }
  template <class T, int D>
  static Vec<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    return Each(s, [p](const T& si) {
      const T u = T(1.0) / si, square = u * u;
      return p[0] * MulAdd(T(3.0) * square, square, T(1.0));
    });
  }
};

template <>
inline constexpr bool kStudied<Distortion<Tetrahedron, SymmetricDirichlet>> = true;

DEFINITE_ENERGY(Distortion<Triangle, SymmetricDirichlet>);
DEFINITE_ENERGY(Distortion<Tetrahedron, SymmetricDirichlet>);

}  // namespace definite
