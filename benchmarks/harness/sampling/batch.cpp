#include "benchmarks/harness/sampling/batch.hpp"

#include <algorithm>

namespace definite {

void ToTiles(const double* scalar, int numbers, std::int64_t size, double* tiled) {
  for (std::int64_t i = 0; i < size; ++i) {
    for (int k = 0; k < numbers; ++k) {
      tiled[(i / kTile * numbers + k) * kTile + i % kTile] = scalar[i * numbers + k];
    }
  }
}

void FromTiles(const double* tiled, int numbers, std::int64_t size, double* scalar) {
  for (std::int64_t i = 0; i < size; ++i) {
    for (int k = 0; k < numbers; ++k) {
      scalar[i * numbers + k] = tiled[(i / kTile * numbers + k) * kTile + i % kTile];
    }
  }
}

void Batch::Draw(const Distribution& distribution, std::uint64_t seed, std::uint64_t first,
                 std::int64_t size) {
  Resize(size);
  const DrawTarget target = {energy_->stencil, energy_->dofs, energy_->parameters};
  for (std::int64_t i = 0; i < size; ++i) {
    distribution.draw(target, seed, first + static_cast<std::uint64_t>(i),
                      x_.Data() + Offset(i, energy_->dofs), p_.Data() + Offset(i, Parameters()));
    // Before the mirror: a parameter may tell where the energy is defined.
    OverrideParameters(energy_->parameters, overrides_, p_.Data() + Offset(i, Parameters()));
    if (!energy_->mirror.empty() && !distribution.recorded) Mirror(i);
  }
  Tile();
}

void Batch::Mirror(std::int64_t i) {
  double classification[3];
  energy_->classify(X(i), P(i), classification, 1);
  if (classification[1] == 1) return;
  const auto size = static_cast<std::size_t>(energy_->dimension);
  double* x = x_.Data() + Offset(i, energy_->dofs);
  const std::vector<double> old(x, x + energy_->dofs);
  for (const int vertex : energy_->mirror) {
    x = std::copy_n(old.data() + static_cast<std::size_t>(vertex) * size, size, x);
  }
}

void Batch::Take(const Batch& from, std::span<const std::int64_t> indices) {
  Resize(WholeTiles(static_cast<std::int64_t>(indices.size())));
  for (std::int64_t i = 0; i < size_; ++i) {
    const std::int64_t source = indices[std::min(static_cast<std::size_t>(i), indices.size() - 1)];
    std::copy_n(from.X(source), energy_->dofs, x_.Data() + Offset(i, energy_->dofs));
    std::copy_n(from.P(source), Parameters(), p_.Data() + Offset(i, Parameters()));
  }
  Tile();
}

void Batch::Resize(std::int64_t size) {
  size_ = size;
  for (auto* numbers : {&x_, &tiled_x_}) numbers->Resize(Offset(size, energy_->dofs));
  for (auto* numbers : {&p_, &tiled_p_}) numbers->Resize(Offset(size, Parameters()));
}

void Batch::Tile() {
  ToTiles(x_.Data(), energy_->dofs, size_, tiled_x_.Data());
  ToTiles(p_.Data(), Parameters(), size_, tiled_p_.Data());
}

void RunOne(const KernelRow& row, const double* x, const double* p, double* out) {
  const auto spread = [&](const double* numbers, std::size_t count) {
    std::vector<double> tile;
    for (std::size_t k = 0; k < count; ++k) {
      tile.insert(tile.end(), static_cast<std::size_t>(row.lanes), numbers[k]);
    }
    return tile;
  };
  const std::vector<double> xs = spread(x, static_cast<std::size_t>(row.energy->dofs));
  const std::vector<double> ps = spread(p, row.energy->parameters.size());
  std::vector<double> tile(static_cast<std::size_t>(row.outputs * row.lanes));
  row.run(xs.data(), ps.data(), tile.data(), 1);
  for (int k = 0; k < row.outputs; ++k) out[k] = tile[static_cast<std::size_t>(k * row.lanes)];
}

}  // namespace definite
