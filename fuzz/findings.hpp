#pragma once

// What a run found: promises that are broken, and the simplest configuration that shows it.

#include <string>
#include <vector>

#include "fuzz/run.hpp"

namespace definite::fuzz {

// The same promise broken by rows of one energy in one family.
struct Finding {
  Cell cell;                           // the least degenerate of them
  std::string what;                    // a promise; "consistent", of value and gradient; or "crash"
  std::vector<const KernelRow*> rows;  // none if a cell died and no single case did it
  std::uint64_t index;                 // in the cell, of the first row
  int cells;                           // that show it
  std::string how;                     // of a crash
};

// Of the cells' JSON, in the order of their plan.
std::vector<Finding> FindingsOf(const Plan& plan, const std::vector<nlohmann::ordered_json>& cells);

// The command that shows it whole; empty without a row.
std::string ReplayCommand(const Finding& finding);

// A configuration of one energy.
struct Example {
  std::vector<double> x, p;
};

// What genes make, on the side where the energy is defined.
Example ExampleOf(const EnergyRow& energy, const Family& family, const Genes& genes);

// The configuration of a finding, and one that is made as simple as it can be and still breaks the
// promise: not turned, of few digits, as far from degenerate as it goes. Not for crashes.
Example Found(const Finding& finding);
Example Shrunk(const Finding& finding);

// Whether a row breaks a promise there.
bool Breaks(const KernelRow& row, const std::string& what, const Example& example);

// The command that looks where it was found.
std::string FuzzCommand(const Finding& finding);

// A file of fuzz/corpus: configurations on record with one line (docs/advice.md), headed by the
// command that found it and by what is broken.
std::string CorpusText(const std::string& command, const std::string& what, const EnergyRow& energy,
                       const Example& example);

}  // namespace definite::fuzz
