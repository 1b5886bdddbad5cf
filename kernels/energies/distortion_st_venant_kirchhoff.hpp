#pragma once

// St. Venant-Kirchhoff: psi = mu |E|^2 + k/2 tr(E)^2 with E = (F^T F - I)/2.
//
// Source: Smith, de Goes and Kim 2019, appendix F.3, whose |E| lacks its square.
// Parameters: mu, k (energies).

#include "kernels/distortion/distortion.hpp"

namespace definite {

struct StVenantKirchhoff {
  static constexpr std::string_view kName = "st_venant_kirchhoff";
  static constexpr std::string_view kSource = "Smith et al. 2019, appendix F.3, corrected";
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness of shape, times the rest volume"},
      {"k", 1.0, 2, "stiffness of volume, times the rest volume"},
  };
  static constexpr Stretchable kDomain = Stretchable::kAlways;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> strain = Strains(s);
    const T trace = Sum(strain);
    return MulAdd(p[0], Dot(strain, strain), T(0.5) * p[1] * trace * trace);
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const Vec<T, D> strain = Strains(s);
    const T volume = p[1] * Sum(strain);
    Vec<T, D> slopes;
    for (int i = 0; i < D; ++i) slopes[i] = s[i] * MulAdd(T(2.0) * p[0], strain[i], volume);
    return slopes;
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    // s_j^2 - s_j s_k + s_k^2 - 1, of what vanishes at rest
    const T j = pair.j, k = pair.k, difference = j - k;
    return MulAdd(p[0], MulAdd(difference, difference, MulAdd(j, k, T(-1.0))),
                  p[1] * Sum(Strains(s)));
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    const T j = pair.j, k = pair.k, sum = j + k;
    return MulAdd(p[0], MulAdd(sum, sum, -MulAdd(j, k, T(1.0))), p[1] * Sum(Strains(s)));
  }
  template <class T, int D>
  static PackedSym<T, D> Scaling(const Vec<T, D>& s, const T* p) {
    const T volume = p[1] * Sum(Strains(s));
    return SymmetricOf<D>([&](int i, int j) {
      const T cross = p[1] * s[i] * s[j];
      return i == j ? cross + MulAdd(p[0], T(3.0) * s[i] * s[i] - T(1.0), volume) : cross;
    });
  }

  // Gauss-Newton of the residual E.
  template <class T, int D>
  static PackedSym<T, D> ScalingCurvature(const Vec<T, D>& s, const T* p) {
    return SymmetricOf<D>([&](int i, int j) {
      const T cross = p[1] * s[i] * s[j];
      return i == j ? MulAdd(T(2.0) * p[0] * s[i], s[i], cross) : cross;
    });
  }
  template <class T, int D>
  static Modes<T, 2, 2> PairCurvature(const Vec<T, D>&, const StretchPair<T>& pair, const T* p) {
    return {{p[0], T(0.0)}, {{pair.j, pair.k}, {pair.k, -pair.j}}};
  }

 private:
  // (s^2 - 1)/2
  template <class T, int D>
  static Vec<T, D> Strains(const Vec<T, D>& s) {
    return Each(s, [](const T& si) { return T(0.5) * (si - T(1.0)) * (si + T(1.0)); });
  }
};

DEFINITE_ENERGY(Distortion<Triangle, StVenantKirchhoff>);
DEFINITE_ENERGY(Distortion<Tetrahedron, StVenantKirchhoff>);

}  // namespace definite
