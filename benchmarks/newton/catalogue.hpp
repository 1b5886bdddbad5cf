#pragma once

// The problems that come with the program.

#include <span>
#include <string_view>

#include "benchmarks/newton/problem.hpp"

namespace definite::newton {

struct Template {
  std::string_view name, meaning;
  std::string_view stencil;  // of its energies
  bool inverts;              // its start has inverted elements: only for energies defined there
  // A coarse mesh has a tenth of the elements or fewer.
  Problem (*make)(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t seed);

  bool Fits(const EnergyRow& energy) const;
};

std::span<const Template> AllProblems();

}  // namespace definite::newton
