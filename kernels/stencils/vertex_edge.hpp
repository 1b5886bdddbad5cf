#pragma once

// A vertex x0 beside an edge x1, x2.
//
// Source: docs/derivations.md, section 3; the conventions of Shi & Kim 2023.

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct VertexEdge {
  static constexpr std::string_view kName = "vertex_edge";
  static constexpr int kVertices = 3;
  static constexpr int kDofs = 9;
  static constexpr int kDimension = 3;
  static constexpr int kRelabellings[] = {0, 2, 1};  // the edge reversed
  static constexpr int kTree[] = {1, 0, 1, 2};

  // Edges x2 - x1 and x0 - x1.
  static constexpr int kEdges = 2;
  static constexpr int kInEdges[3][2] = {{0, 1}, {-1, -1}, {1, 0}};
};

}  // namespace definite
