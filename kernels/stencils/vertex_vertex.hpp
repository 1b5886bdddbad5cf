#pragma once

// Two vertices.
//
// Source: docs/derivations.md, section 3.

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct VertexVertex {
  static constexpr std::string_view kName = "vertex_vertex";
  static constexpr int kVertices = 2;
  static constexpr int kDofs = 6;
  static constexpr int kDimension = 3;
  static constexpr int kRelabellings[] = {1, 0};
  static constexpr int kTree[] = {0, 1};

  // The edge x1 - x0.
  static constexpr int kEdges = 1;
  static constexpr int kInEdges[2][1] = {{-1}, {1}};
};

}  // namespace definite
