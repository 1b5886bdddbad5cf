#pragma once

// Eigendecomposition of the full matrix in single precision, clamp, rebuild. Scalar only.

#include "kernels/core/eigen.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericFloat {
  static constexpr std::string_view kName = "numeric_float";
  static constexpr std::string_view kSource =
      "Eigen SelfAdjointEigenSolver in float, clamp, rebuild";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kPsd, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kKeepsPsd, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kMajorises, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kRigidMotion, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kTranslation, "its error is the roundoff of float, 2^-24, times |H|"},
      {Property::kRelabelling, "its error is the roundoff of float, 2^-24, times |H|"},
  };

  template <class E, class T>
  requires kStudied<E> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampInFloat(ToPacked(None::Apply<E>(x, p)));
  }
};

DEFINITE_FILTER(NumericFloat);

}  // namespace definite
