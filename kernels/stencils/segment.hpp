#pragma once

// Two neighbouring vertices of a strand, x0 and x1.
//
// Source: Shi & Kim 2023, section 5.2.1: the cables' springs.

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct Segment {
  static constexpr std::string_view kName = "segment";
  static constexpr int kVertices = 2;
  static constexpr int kDofs = 6;
  static constexpr int kDimension = 3;
  static constexpr int kRelabellings[] = {1, 0};  // read from the other end
  static constexpr int kTree[] = {0, 1};
};

}  // namespace definite
