#pragma once

// How near a configuration is to those where the energies of contact lose digits, or their meaning
// (docs/advice.md, "Nearly degenerate").

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace definite {

// A family of degenerate configurations. Its delta is a pure number that is 0 in the family, and is
// 1 or more far from it.
struct Degeneracy {
  std::string_view name, meaning;
  std::span<const std::string_view> stencils;
  double (*delta)(std::string_view stencil, const double* x);  // x: as the stencil has it
};

std::span<const Degeneracy> AllDegeneracies();

// Below this delta a configuration counts as degenerate. At an angle of 1e-4 the formulas as
// printed have lost half their digits (tests/degenerate_test.cpp).
inline constexpr double kDegenerate = 1e-4;

// How many configurations of a family there are, and the nearest to it.
struct DegeneracyCount {
  const Degeneracy* family;
  std::uint64_t count = 0;
  double smallest = 1;
  std::optional<std::uint64_t> index;  // of the smallest, unless that is 1

  void Add(double delta, std::uint64_t at);
  void Merge(const DegeneracyCount& other);
};

// One for each family that a stencil has.
std::vector<DegeneracyCount> DegeneraciesOf(std::string_view stencil);

}  // namespace definite
