#pragma once

// Four vertices of a strand in their order: e0 = x0 - x1, e1 = x2 - x1, e2 = x3 - x2.
//
// Source: Shi et al. 2023, Lifted Curls, supplement, section 2.

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct Torsion {
  static constexpr std::string_view kName = "torsion";
  static constexpr int kVertices = 4;
  static constexpr int kDofs = 12;
  static constexpr int kDimension = 3;
  static constexpr int kRelabellings[] = {3, 2, 1, 0};  // read from the other end
  static constexpr int kTree[] = {1, 0, 1, 2, 2, 3};
};

}  // namespace definite
