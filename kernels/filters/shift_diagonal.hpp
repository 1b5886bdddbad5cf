#pragma once

// H - lambda_min I where the smallest eigenvalue is negative: the least multiple of the identity
// that makes it PSD. The eigenvalue is that of the 5x5 matrix in the range of the modes, and H the
// sum of these modes: of other modes it would be off by their rounding.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/core/shift.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct ShiftDiagonal {
  static constexpr std::string_view kName = "shift_diagonal";
  static constexpr std::string_view kSource = "H - lambda_min I; docs/derivations.md, section 1";
  static constexpr Exemption kExempt[] = {
      {Property::kTranslation, "a multiple of the identity resists translation"},
  };

  template <class E, class T>
  requires kStudied<E> && OffersSet<E, T, Set::kSplit>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    const auto modes = Stacked(E::template HessianModes<Set::kSplit, Part::kAll>(x, p));
    const auto reduced = Reduce(modes);
    const auto e = SolveInUnits<ByQl>(reduced.h);
    T shift = T(0.0);
    for (const T& value : e.values) shift = Max(-value, shift);
    return AddToDiagonal(ToPacked(modes), shift);
  }
};

DEFINITE_FILTER(ShiftDiagonal);

}  // namespace definite
