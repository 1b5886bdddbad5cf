#pragma once

// The clamp in the reduced frame, pulled back, by cyclic Jacobi rotations that lanes share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Jacobi9 {
  static constexpr std::string_view kName = "jacobi_9";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.5";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H| of the frame, however small the result"},
      {Property::kMajorises, "the same error, which a short edge magnifies beyond u |H|"},
      {Property::kRigidMotion, "the same error, which a short edge magnifies beyond u |H|"},
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  requires kStudied<E>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return ClampInFrame<ByJacobi>(std::get<0>(E::FrameTerms(x, p)));
  }
};

DEFINITE_FILTER(Jacobi9);

}  // namespace definite
