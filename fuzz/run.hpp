#pragma once

// A run over families of degenerate configurations, cut into cells: one energy on one decade of one
// family. A cell is judged whole, in a process of its own, and is what a run is shared out by, kept
// as and resumed from.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmarks/harness/sweep.hpp"
#include "fuzz/family.hpp"

namespace definite::fuzz {

struct Plan {
  std::vector<const KernelRow*> rows;
  std::vector<const Family*> families;
  std::uint64_t seed = 42, passes = 1;  // over all cells, each with a seed of its own from here on
  std::uint64_t each = 32;              // configurations of a cell
  Samples samples;                      // of those
  bool worst_cases = true;              // judged in float128
};

struct Cell {
  std::uint64_t seed;
  const EnergyRow* energy;
  const Family* family;
  int decade;

  std::string Distribution() const;  // "fuzz/sliver/5"
  std::string Name() const;          // "collision/.../quadratic fuzz/sliver/5 seed 42"
};

// Pass by pass; from the least degenerate decade on, all families and energies in each.
std::vector<Cell> CellsOf(const Plan& plan);

// The name of the cell that some JSON is of.
std::string NameOf(const nlohmann::ordered_json& cell);

// As JSON; of one pass two plans are equal if their cells are.
nlohmann::ordered_json ToJson(const Plan& plan);

// A case that ended the process.
struct Crash {
  const KernelRow* row;  // null if no single case did it alone
  std::uint64_t index;
  std::string how;
};

// What became of a cell: results/schema.json has it as "cell".
nlohmann::ordered_json Check(const Plan& plan, const Cell& cell, std::vector<Crash> crashes = {});

struct RunOptions {
  int processes = 1;
  double cell_seconds = 600, case_seconds = 2;  // of processor time, before it counts as a hang
};

// Judges cells in child processes; done(cell, json) is called here, in any order. A case that
// crashes or hangs is found, and the cell judged without that row. Ends early if interrupted.
void Run(const Plan& plan, const std::vector<Cell>& cells, const RunOptions& options,
         const std::function<void(const Cell&, nlohmann::ordered_json)>& done);

}  // namespace definite::fuzz
