#pragma once

// What a penalty psi(l) of a length l offers; it acts where l < eps, and is 0 beyond.
//
//   kStiffnessPower       of the unit of length in k, such that the Hessian has none
//   kOneSided             not defined for l <= 0
//   kParameters           of its own, after k and eps
//   Outside(l, p)         where psi is not defined; a NaN is not outside
//   Value(l, p)           psi
//   Derivatives(l, p)     psi'/unit and psi'' of a length `l unit`, p being in that unit too
//
// p = (k, eps, its own). On its active set psi' <= 0 and psi'' > 0: a penalty only ever repels.

#include <array>
#include <string_view>

#include "kernels/kernel.hpp"

namespace definite {

template <class T>
struct Slopes {
  T psi1, psi2;
};

}  // namespace definite
