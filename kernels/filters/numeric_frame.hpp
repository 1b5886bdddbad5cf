#pragma once

// Eigendecomposition in the reduced frame, clamp, pull back. Scalar only.

#include <functional>

#include "kernels/core/eigen.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct NumericFrame {
  static constexpr std::string_view kName = "numeric_frame";
  static constexpr std::string_view kSource =
      "Shi & Kim 2023, Eq. 17; Eigen SelfAdjointEigenSolver";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H| of the frame, however small the result"},
      {Property::kPsd, "the same error leaves eigenvalues of about -u |H|"},
      {Property::kMajorises, "the same error, which a short edge magnifies beyond u |H|"},
      {Property::kRigidMotion, "the same error, which a short edge magnifies beyond u |H|"},
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  requires WithFrame<E, T> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return FilterInFrame<E>(x, p, std::identity(), ClampToPsd);
  }
};

DEFINITE_FILTER(NumericFrame);

}  // namespace definite
