#include "kernels/registry.hpp"

#include <algorithm>

namespace definite {

namespace {

struct Tables {
  std::vector<EnergyRow> energies;
  std::vector<KernelRow> kernels;

  Tables() {
    const std::vector<EnergyTable> parts = EnergyTables();
    energies.reserve(parts.size());  // rows point into it
    for (const EnergyTable& part : parts) {
      energies.push_back(part.energy);
      for (KernelRow row : part.kernels) {
        row.energy = &energies.back();
        kernels.push_back(row);
      }
    }
  }
};

const Tables& AllTables() {
  static const Tables tables;
  return tables;
}

}  // namespace

std::span<const EnergyRow> AllEnergies() { return AllTables().energies; }
std::span<const KernelRow> AllKernels() { return AllTables().kernels; }

const KernelRow* FindKernel(std::string_view name) {
  const auto rows = AllKernels();
  const auto at = std::ranges::find(rows, name, &KernelRow::name);
  return at == rows.end() ? nullptr : &*at;
}

}  // namespace definite
