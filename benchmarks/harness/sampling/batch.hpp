#pragma once

// Configurations drawn for one energy, in the layouts the rows want.

#include <cstdint>
#include <span>
#include <vector>

#include "benchmarks/harness/sampling/distribution.hpp"
#include "kernels/core/aligned_doubles.hpp"
#include "kernels/kernel.hpp"

namespace definite {

inline constexpr int kTile = 8;  // configurations in the widest tile; batches are multiples of it

// Rounds up to whole tiles.
constexpr std::int64_t WholeTiles(std::int64_t count) {
  return (count + kTile - 1) / kTile * kTile;
}

// `size` configurations of an energy, each number twice: in scalar tiles, and in tiles of eight.
class Batch {
 public:
  // Parameters in `overrides`, which must outlive the batch, have that value whatever the
  // distribution says.
  explicit Batch(const EnergyRow& energy, std::span<const ParameterValue> overrides = {})
      : energy_(&energy), overrides_(overrides) {}

  // Draws the configurations first, first + 1, ... of a distribution; size is a multiple of kTile.
  // Those on the side where the energy is not defined are mirrored, unless they are on record.
  void Draw(const Distribution& distribution, std::uint64_t seed, std::uint64_t first,
            std::int64_t size);

  // Takes some configurations of another batch of the same energy, and fills up to whole tiles with
  // the last of them.
  void Take(const Batch& from, std::span<const std::int64_t> indices);

  std::int64_t Size() const { return size_; }
  // Configuration i, in scalar layout.
  const double* X(std::int64_t i) const { return x_.Data() + Offset(i, energy_->dofs); }
  const double* P(std::int64_t i) const { return p_.Data() + Offset(i, Parameters()); }

  // The tiles from configuration i on, as a row with that many lanes reads them.
  const double* TilesX(int lanes, std::int64_t i) const {
    return lanes == 1 ? X(i) : tiled_x_.Data() + Offset(i, energy_->dofs);
  }
  const double* TilesP(int lanes, std::int64_t i) const {
    return lanes == 1 ? P(i) : tiled_p_.Data() + Offset(i, Parameters());
  }

 private:
  void Mirror(std::int64_t i);
  void Resize(std::int64_t size);
  void Tile();
  int Parameters() const { return static_cast<int>(energy_->parameters.size()); }
  static std::size_t Offset(std::int64_t i, int numbers) {
    return static_cast<std::size_t>(i * numbers);
  }

  const EnergyRow* energy_;
  std::span<const ParameterValue> overrides_;
  std::int64_t size_ = 0;
  AlignedDoubles x_, p_, tiled_x_, tiled_p_;
};

// Scalar layout (entry k of configuration i at [i * numbers + k]) to tiles of eight, and back.
void ToTiles(const double* scalar, int numbers, std::int64_t size, double* tiled);
void FromTiles(const double* tiled, int numbers, std::int64_t size, double* scalar);

// Runs a row on one configuration, whatever its lanes; `out` has row.outputs numbers.
void RunOne(const KernelRow& row, const double* x, const double* p, double* out);

}  // namespace definite
