#pragma once

// The clamp in the reduced frame, pulled back, by Householder tridiagonalisation and implicit QL
// that lanes share.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct Ql9 {
  static constexpr std::string_view kName = "ql_9";
  static constexpr std::string_view kSource = "Golub & Van Loan, section 8.3";
  static constexpr bool kInPairs = true;
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
    return ClampInFrame<ByQl>(std::get<0>(E::FrameTerms(x, p)));
  }
};

DEFINITE_FILTER(Ql9);

}  // namespace definite
