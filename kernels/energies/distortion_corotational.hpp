#pragma once

// Co-rotational: psi = mu sum (s_i - 1)^2 + k/2 (sum (s_i - 1))^2.
//
// Source: Smith, de Goes and Kim 2019, appendix F.1; its twist and its constants are misprinted.
// Parameters: mu, k (energies).

#include "kernels/energies/distortion_arap.hpp"

namespace definite {

struct Corotational {
  static constexpr std::string_view kName = "corotational";
  static constexpr std::string_view kSource = "Smith et al. 2019, appendix F.1, corrected";
  static constexpr Parameter kParameters[] = {
      {"mu", 1.0, 2, "stiffness of shape, times the rest volume"},
      {"k", 1.0, 2, "stiffness of volume, times the rest volume"},
  };
  static constexpr Stretchable kDomain = Stretchable::kWithRotation;

  template <class T, int D>
  static T Value(const Vec<T, D>& s, const T* p) {
    const T trace = Strain(s);
    return Arap::Value(s, p) + T(0.5) * p[1] * trace * trace;
  }
  template <class T, int D>
  static Vec<T, D> Slopes(const Vec<T, D>& s, const T* p) {
    const T volume = p[1] * Strain(s);
    return Each(s, [&](const T& si) { return MulAdd(T(2.0) * p[0], si - T(1.0), volume); });
  }
  template <class T, int D>
  static T Twist(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return Arap::Twist(s, pair, p) + T(2.0) * p[1] * Strain(s) / (pair.j + pair.k);
  }
  template <class T, int D>
  static T Flip(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return Arap::Flip(s, pair, p);
  }
  // 2 mu I + k 1 1^T.
  template <class T, int D>
  static Modes<T, D, D> Scaling(const Vec<T, D>&, const T* p) {
    const T shape = T(2.0) * p[0];
    Modes<T, D, D> modes;
    modes.lambda[0] = shape + T(static_cast<double>(D)) * p[1];
    for (int m = 1; m < D; ++m) modes.lambda[m] = shape;
    const T none = T(0.0), half = ConstantRoot<T>::Of(2) / T(2.0);
    if constexpr (D == 2) {
      modes.v[0] = {half, half};
      modes.v[1] = {half, -half};
    } else {
      const T third = ConstantRoot<T>::Of(3) / T(3.0), sixth = ConstantRoot<T>::Of(6) / T(6.0);
      modes.v[0] = {third, third, third};
      modes.v[1] = {half, -half, none};
      modes.v[2] = {sixth, sixth, T(-2.0) * sixth};
    }
    return modes;
  }

  // Gauss-Newton of the residuals F - R and tr(R^T F - I).
  template <class T, int D>
  static Modes<T, D, D> ScalingCurvature(const Vec<T, D>& s, const T* p) {
    return Scaling(s, p);
  }
  template <class T, int D>
  static Modes<T, 2, 2> PairCurvature(const Vec<T, D>& s, const StretchPair<T>& pair, const T* p) {
    return Arap::PairCurvature(s, pair, p);
  }

 private:
  template <class T, int D>
  static T Strain(const Vec<T, D>& s) {
    return Sum(Each(s, [](const T& si) { return si - T(1.0); }));
  }
};

DEFINITE_ENERGY(Distortion<Triangle, Corotational>);
DEFINITE_ENERGY(Distortion<Tetrahedron, Corotational>);

}  // namespace definite
