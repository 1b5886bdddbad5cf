#include "kernels/registry.hpp"

#include <algorithm>

namespace definite {

namespace {

struct Tables {
  std::vector<EnergyRow> energies;
  std::vector<KernelRow> kernels, outputs;

  Tables() {
    const std::vector<EnergyTable> parts = EnergyTables();
    energies.reserve(parts.size());  // rows point into it
    for (const EnergyTable& part : parts) {
      energies.push_back(part.energy);
      for (KernelRow row : part.kernels) {
        row.energy = &energies.back();
        kernels.push_back(row);
      }
      for (KernelRow row : part.outputs) {
        row.energy = &energies.back();
        outputs.push_back(row);
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
std::span<const KernelRow> AllOutputs() { return AllTables().outputs; }

const KernelRow* FindKernel(std::string_view name) {
  for (const auto rows : {AllKernels(), AllOutputs()}) {
    const auto at = std::ranges::find(rows, name, &KernelRow::name);
    if (at != rows.end()) return &*at;
  }
  return nullptr;
}

}  // namespace definite
