#pragma once

// Three vertices of a strand: the edges from the middle one, x1, to its neighbours.
//
// Source: Shi et al. 2023, Lifted Curls, supplement, section 1.

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct Corner {
  static constexpr std::string_view kName = "corner";
  static constexpr int kVertices = 3;
  static constexpr int kDofs = 9;
  static constexpr int kDimension = 3;
  static constexpr int kRelabellings[] = {2, 1, 0};  // read from the other end
  static constexpr int kTree[] = {1, 0, 1, 2};
};

}  // namespace definite
