#pragma once

// A vertex x0 over a triangle x1, x2, x3, as the edges the length functions work on.
//
// Source: Shi & Kim 2023, section 3.1 and Eq. 19 (left). Orientation: with these edges e0 x e1 is
// opposite to the counter-clockwise normal of (x1, x2, x3).

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct VertexFace {
  static constexpr std::string_view kName = "vertex_face";
  static constexpr int kVertices = 4;
  static constexpr int kDofs = 12;
  static constexpr int kDimension = 3;
  // Cyclic turns of the triangle. A swap of two of its vertices would flip the signed length.
  static constexpr int kRelabellings[] = {0, 2, 3, 1, 0, 3, 1, 2};
  static constexpr int kMirror[] = {0, 3, 2, 1};  // one that does flip it
  static constexpr int kTree[] = {2, 1, 2, 3, 2, 0};

  static constexpr int kEdges = 3;
  static constexpr int kInEdges[4][3] = {{0, 0, 1}, {1, 0, 0}, {-1, -1, -1}, {0, 1, 0}};

  // e0 = x1 - x2, e1 = x3 - x2, e2 = x0 - x2.
  template <class T>
  static DEFINITE_INLINE Edges<T> EdgesOf(const Vec<T, kDofs>& x) {
    const Vec3<T> x2 = Vertex(x, 2);
    return {Vertex(x, 1) - x2, Vertex(x, 3) - x2, Vertex(x, 0) - x2};
  }
};

}  // namespace definite
