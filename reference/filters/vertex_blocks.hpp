#pragma once

#include <string_view>

#include "reference/filter.hpp"

namespace definite::reference {

// The clamped 3x3 block of each vertex, and zero between vertices.
struct VertexBlocks {
  static constexpr std::string_view kName = "vertex_blocks";

  template <class T>
  static Matrix<T> Define(Truth<T>& truth) {
    const Matrix<T>& h = truth.Hessian();
    Matrix<T> blocks = h;
    for (T& entry : blocks.entries) entry *= 0;  // NaN stays
    for (int first = 0; first < h.rows; first += 3) {
      Matrix<T> block(3, 3);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) block(i, j) = h(first + i, first + j);
      block = NearestPsd(SpectrumOf(block));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) blocks(first + i, first + j) = block(i, j);
    }
    return blocks;
  }
};

DEFINITE_REFERENCE_FILTER(VertexBlocks);

}  // namespace definite::reference
