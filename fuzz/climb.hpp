#pragma once

// A hill climb over the genes of a family, for the largest known defect of a row.

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "fuzz/findings.hpp"

namespace definite::fuzz {

// What a climb looks for: a figure of docs/protocol.md, section 1.
struct Slope {
  std::string_view name, meaning;
  Depth depth;
  double (*of)(const RowFigures& figures);  // NaN where there is none
};
std::span<const Slope> AllSlopes();

// The highest place of a climb.
struct Summit {
  const KernelRow* row;
  const Family* family;
  Genes genes;
  double value;  // negative if no configuration was active and in the domain
};

// Looks at so many configurations: a quarter drawn, then steps from the best so far. The same seed
// climbs the same way.
Summit Climb(const KernelRow& row, const Family& family, const Slope& slope, std::uint64_t seed,
             std::uint64_t evaluations);

// The highest of each row over all families that fit it, the highest first; done() is called after
// each climb, by one thread at a time. Ends early if interrupted.
std::vector<Summit> ClimbAll(std::span<const KernelRow* const> rows,
                             std::span<const Family* const> families, const Slope& slope,
                             std::uint64_t seed, std::uint64_t evaluations, int threads,
                             const std::function<void()>& done);

std::string ToTable(const Slope& slope, const std::vector<Summit>& summits);
nlohmann::ordered_json ToJson(const Slope& slope, std::uint64_t evaluations,
                              const std::vector<Summit>& summits);

}  // namespace definite::fuzz
