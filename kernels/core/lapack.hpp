#pragma once

// What the numeric filters ask of LAPACK. The library itself stays in lapack.cpp.

#include "kernels/kernel.hpp"

namespace definite {

enum class LapackDriver {
  kDivideAndConquer,                 // dsyevd, which below 26 rows is QL
  kRelativelyRobustRepresentations,  // dsyevr
};

// The positive part of h; by Eigen where LAPACK does not converge.
PackedSym<double, 12> ClampByLapack(const PackedSym<double, 12>& h, LapackDriver driver);

}  // namespace definite
