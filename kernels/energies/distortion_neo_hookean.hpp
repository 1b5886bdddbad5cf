#pragma once

// Neo-Hookean, L = log det F: psi = mu/2 (|F|^2 - d) - mu L + lambda/2 L^2.
//
// Source: Bonet and Wood 2008, Eq. 6.28; the theorem of stretches.hpp. Parameters: mu, lambda
// (energies).

#include "kernels/distortion/distortion.hpp"
#include "kernels/distortion/logarithms.hpp"

namespace definite {

struct NeoHookean {
  static constexpr std::string_view kName = "neo_hookean";
  static constexpr std::string_view kSource = "Bonet & Wood 2008, Eq. 6.28; Smith et al. 2019";
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness of shape, times the rest volume"},
      {"lambda", 10.0, 2, "stiffness of volume, times the rest volume"},
  };
  static constexpr Stretchable kDomain = Stretchable::kNotInverted;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const T shape = Sum(Each(s, [](const T& si) {
      const T x = si - T(1.0);
      return MulAdd(T(0.5) * x, x, LessLog(x, si));
    }));
    const T volume = LogVolume(s);
    return MulAdd(p[0], shape, T(0.5) * p[1] * volume * volume);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const T volume = p[1] * LogVolume(s);
    return Each(
        s, [&](const T& si) { return MulAdd(p[0], (si - T(1.0)) * (si + T(1.0)), volume) / si; });
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return p[0] + MulAdd(p[1], LogVolume(s), -p[0]) / (pair.j * pair.k);
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return p[0] - MulAdd(p[1], LogVolume(s), -p[0]) / (pair.j * pair.k);
  }
  template <class T, int D>
  static PackedSym<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    const T minus_slope = MulAdd(-p[1], LogVolume(s), p[0]);
    return SymmetricOf<D>([&](int i, int j) {
      const T u = T(1.0) / (s[i] * s[j]);
      return i == j ? MulAdd(p[1] + minus_slope, u, p[0]) : p[1] * u;
    });
  }

 private:
  template <class T, int D>
  static T LogVolume(const Vec<T, D>& s) {
    return Sum(Each(s, [](const T& si) { return LogOf(si - T(1.0), si); }));
  }
};

DEFINITE_ENERGY(Distortion<Triangle, NeoHookean>);
DEFINITE_ENERGY(Distortion<Tetrahedron, NeoHookean>);

}  // namespace definite
