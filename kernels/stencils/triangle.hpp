#pragma once

// Three vertices of a triangle in the plane: the edges from x0 to the others.
//
// Source: Smith, de Goes and Kim 2019, section 2.

#include <span>
#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct Triangle {
  static constexpr std::string_view kName = "triangle";
  static constexpr int kVertices = 3;
  static constexpr int kDofs = 6;
  static constexpr int kDimension = 2;
  static constexpr std::span<const int> kRelabellings{};  // the rest shape is numbered too
  static constexpr int kTree[] = {0, 1, 0, 2};
};

}  // namespace definite
