#pragma once

// H + s I, with the least s that makes it diagonally dominant: Gershgorin's bound of its smallest
// eigenvalue, where that is negative.

#include "kernels/core/shift.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct ShiftGershgorin {
  static constexpr std::string_view kName = "shift_gershgorin";
  static constexpr std::string_view kSource = "Gershgorin 1931: H plus a multiple of the identity";
  static constexpr Exemption kExempt[] = {
      {Property::kKeepsPsd, "a PSD matrix need not be diagonally dominant"},
      {Property::kRigidMotion, "the bound depends on the axes"},
      {Property::kTranslation, "a multiple of the identity resists translation"},
  };

  template <class E, class T>
  requires kStudied<E>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    PackedSym<T, E::kDofs> h = ToPacked(None::Apply<E>(x, p));
    T radius[E::kDofs];
    for (int i = 0; i < E::kDofs; ++i) radius[i] = T(0.0);
    int k = 0;
    for (int i = 0; i < E::kDofs; ++i) {
      radius[i] = radius[i] - h.a[k++];
      for (int j = i + 1; j < E::kDofs; ++j) {
        const T magnitude = Abs(h.a[k++]);
        radius[i] = radius[i] + magnitude;
        radius[j] = radius[j] + magnitude;
      }
    }
    T shift = T(0.0);
    for (const T& r : radius) shift = Max(r, shift);
    return AddToDiagonal(h, shift);
  }
};

DEFINITE_FILTER(ShiftGershgorin);

}  // namespace definite
