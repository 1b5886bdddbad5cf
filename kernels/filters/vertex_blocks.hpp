#pragma once

// The clamp of each vertex' own 3x3 block, all between vertices dropped: a block Jacobi
// preconditioner that is PSD.

#include "kernels/core/lane_clamp.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/registry.hpp"

namespace definite {

struct VertexBlocks {
  static constexpr std::string_view kName = "vertex_blocks";
  static constexpr std::string_view kSource = "block Jacobi: 3x3 blocks of the vertices, clamped";
  static constexpr Exemption kExempt[] = {
      {Property::kAccurate, "its error is u |H|, however small the result: deep penetration"},
      {Property::kKeepsPsd, "drops what couples the vertices"},
      {Property::kMajorises, "drops what couples the vertices"},
      {Property::kTranslation, "a vertex feels its own motion alone"},
  };

  template <class E, class T>
  requires kStudied<E>
  static auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    constexpr int kD = E::kDofs;
    const PackedSym<T, kD> h = ToPacked(None::Apply<E>(x, p));
    PackedSym<T, kD> blocks;
    for (T& entry : blocks.a) entry = T(0.0);
    const auto at = [](int i, int j) { return i * kD - i * (i - 1) / 2 + j - i; };
    for (int first = 0; first < kD; first += 3) {
      PackedSym<T, 3> block;
      int k = 0;
      for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) block.a[k++] = h.a[at(first + i, first + j)];
      }
      block = ToPackedWithoutMinusZero(PositivePart<ByJacobi>(block));
      k = 0;
      for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) blocks.a[at(first + i, first + j)] = block.a[k++];
      }
    }
    return blocks;
  }
};

DEFINITE_FILTER(VertexBlocks);

}  // namespace definite
