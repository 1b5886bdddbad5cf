#pragma once

// The modes that an energy shows, read from its table.

#include "benchmarks/verify/case.hpp"

namespace definite::verify {

// lambda v v^T, v a unit vector.
struct Mode {
  Quad lambda;
  Matrix v;
};

// Those from number `first` on. A mode of weight zero is left out: it may stand for anything.
inline std::vector<Mode> ModesOf(const Case& at, const ModeTable& table, int first = 0) {
  const int stride = 1 + table.size;
  Numbers numbers(static_cast<std::size_t>(table.count * stride));
  table.write(at.X().data(), at.P().data(), numbers.data(), 1);
  std::vector<Mode> modes;
  for (int m = first; m < table.count; ++m) {
    const double* mode = numbers.data() + m * stride;
    if (mode[0] == 0) continue;
    Matrix v = ToVector(Numbers(mode + 1, mode + stride));
    const Quad norm = FrobeniusNorm(v);
    for (Quad& entry : v.entries) entry /= norm;
    modes.push_back({mode[0] * norm * norm, v});
  }
  return modes;
}

// The map from x to the coordinates of a frame term.
inline Matrix MapOf(const Case& at, const FrameTable& table) {
  Matrix map(table.modes.size, at.Energy().dofs);
  Numbers numbers(map.entries.size());
  table.map(at.X().data(), at.P().data(), numbers.data(), 1);
  std::copy(numbers.begin(), numbers.end(), map.entries.begin());
  return map;
}

}  // namespace definite::verify
