#pragma once

// Four vertices of a tetrahedron: the edges from x0 to the others.
//
// Source: Smith, de Goes and Kim 2019, section 2.

#include <span>
#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct Tetrahedron {
  static constexpr std::string_view kName = "tetrahedron";
  static constexpr int kVertices = 4;
  static constexpr int kDofs = 12;
  static constexpr int kDimension = 3;
  static constexpr std::span<const int> kRelabellings{};  // the rest shape is numbered too
  static constexpr int kTree[] = {0, 1, 0, 2, 0, 3};
};

}  // namespace definite
