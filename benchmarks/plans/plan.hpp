#pragma once

// Named plans of sweeps, each with the tables and claims it is there for: what `definite reproduce`
// runs. Tables and claims are made of results as JSON, so that a published file gives the same ones
// again.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sweep.hpp"

namespace definite {

// One sweep of a plan.
struct PlannedSweep {
  std::vector<std::string> rows;  // globs
  std::string_view distribution;  // rows that it cannot draw are left out
  std::vector<ParameterValue> overrides;
};

struct Plan {
  std::string_view name, purpose;
  std::string count;  // default
  bool timing;
  bool divisible;  // its tables can do without some of the rows
  Detail detail;
  Samples samples;
  std::vector<PlannedSweep> (*sweeps)();
  // [{"claim", "theirs", "ours", "verdict", "reason"}], verdict one of "reproduced", "qualified",
  // "not reproduced"; null if the plan makes none.
  nlohmann::ordered_json (*claims)(const nlohmann::ordered_json& result);
  // Tables and claims as Markdown, readable as it stands at 100 columns. Throws if the result lacks
  // what they need.
  std::string (*markdown)(const nlohmann::ordered_json& result);
};

std::span<const Plan> AllPlans();

// Shi & Kim 2023, "A Unified Analysis of Penalty-Based Collision Energies": its Table 1 and the
// claims around it, held against a sweep of ours.
Plan ShiKim2023();

// Every collision energy with every filter, over every distribution: docs/collision-filters.md.
Plan CollisionAccuracy();

// The distances that an earlier study, independent of this code, found for some of these filters.
Plan FirstStudy();

}  // namespace definite
