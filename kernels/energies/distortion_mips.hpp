#pragma once

// Most isometric parameterisation: psi = mu (|F|^2/det F - 2), in the plane.
//
// Source: Smith, de Goes and Kim 2019, section 5.3 and Eqs. 35 to 37, whose scaling block lacks
// det F twice. Parameters: mu (energy).
// Differs: minus 2, so that rest has no energy; the negative pair of the scaling block by their
// product, which does not cancel.

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct Mips {
  static constexpr std::string_view kName = "mips";
  static constexpr std::string_view kSource = "Smith et al. 2019, section 5.3, corrected";
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, "stiffness, times the rest area"}};
  static constexpr Stretchable kDomain = Stretchable::kNotInverted;

  template <class T>
  static T Value(const Vec<T, 2>& s, const T* p) {
    const T difference = s[0] - s[1];
    return p[0] * difference * difference / (s[0] * s[1]);
  }
  template <class T>
  static Vec<T, 2> Slopes(const Vec<T, 2>& s, const T* p) {
    // 1/s2 - s2/s1^2, and the same exchanged
    const T area = s[0] * s[1], both = p[0] * ((s[0] - s[1]) * (s[0] + s[1])) / area;
    return {both / s[0], -(both / s[1])};
  }
  template <class T>
  static T Twist(const Vec<T, 2>& s, const StretchPair<T>&, const T* p) {
    const T q = (s[0] - s[1]) / (s[0] * s[1]);
    return -(p[0] * q * q);
  }
  template <class T>
  static T Flip(const Vec<T, 2>& s, const StretchPair<T>&, const T* p) {
    const T q = (s[0] + s[1]) / (s[0] * s[1]);
    return p[0] * q * q;
  }
  template <class T>
  static Modes<T, 2, 2> Scaling(const Vec<T, 2>& s, const T* p) {
    const T area = s[0] * s[1], squares = Dot(s, s), difference = (s[0] - s[1]) * (s[0] + s[1]);
    // |F|^4 - 3 det^2, of what does not cancel
    const T alpha = Sqrt(MulAdd(difference, difference, area * area));
    const T sum = MulAdd(squares, alpha, squares * squares - T(2.0) * area * area);
    const T cube = area * area * area, beta = (alpha + difference) / area;
    const T unit = T(1.0) / Sqrt(MulAdd(beta, beta, T(1.0))), other = beta * unit;
    return {{p[0] * sum / cube, -(p[0] * (difference * difference) / (area * sum))},
            {{unit, -other}, {other, unit}}};
  }
};

DEFINITE_ENERGY(Distortion<Triangle, Mips>);

}  // namespace definite
