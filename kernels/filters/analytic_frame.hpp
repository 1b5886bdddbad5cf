#pragma once

// The analytic filter assembled as the paper writes it: 12x9 * 9x9 * 9x12 products in Eigen. Scalar
// only.

#include "kernels/core/eigen.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct AnalyticFrame {
  static constexpr std::string_view kName = "analytic_frame";
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 11-13, 17-19; Eigen products";
  static constexpr Exemption kExempt[] = {
      {Property::kRelabelling,
       "the paper's frame starts at e0, and the frame map is not orthogonal"},
  };

  template <class E, class T>
  requires WithFrame<E, T> && std::same_as<T, double>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return FilterInFrame<E>(x, p, ClampToPsd);
  }
};

DEFINITE_FILTER(AnalyticFrame);

}  // namespace definite
