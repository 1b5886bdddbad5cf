#pragma once

// Two edges, A = (x0, x1) and B = (x2, x3).
//
// Source: Shi & Kim 2023, section 3.1 and Eq. 19 (right).

#include <string_view>

#include "kernels/core/vec.hpp"

namespace definite {

struct EdgeEdge {
  static constexpr std::string_view kName = "edge_edge";
  static constexpr int kVertices = 4;
  static constexpr int kDofs = 12;
  static constexpr int kDimension = 3;
  // The edges swapped; both reversed; both. One edge reversed would flip the signed length.
  static constexpr int kRelabellings[] = {2, 3, 0, 1, 1, 0, 3, 2, 3, 2, 1, 0};
  static constexpr int kMirror[] = {0, 1, 3, 2};
  static constexpr int kTree[] = {0, 1, 0, 2, 2, 3};

  static constexpr int kEdges = 3;
  static constexpr int kInEdges[4][3] = {{-1, 0, -1}, {1, 0, 0}, {0, -1, 1}, {0, 1, 0}};

  // e0 = x1 - x0, e1 = x3 - x2, e2 = x2 - x0.
  template <class T>
  static DEFINITE_INLINE Edges<T> EdgesOf(const Vec<T, kDofs>& x) {
    const Vec3<T> x0 = Vertex(x, 0), x2 = Vertex(x, 2);
    return {Vertex(x, 1) - x0, Vertex(x, 3) - x2, x2 - x0};
  }
};

}  // namespace definite
