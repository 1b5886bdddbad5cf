#pragma once

// definite verify: every check over drawn configurations of every energy.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/harness/progress.hpp"
#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/verify/check.hpp"

namespace definite::verify {

struct Plan {
  std::vector<Subject> subjects;
  std::span<const Check> checks = AllChecks();
  std::vector<const Distribution*> distributions;  // each where it can draw the energy
  std::uint64_t seed = 42;
  std::uint64_t first = 0, count = 1000;  // configurations of each distribution
  int threads = 1;
};

// The worst that a check found.
struct Worst {
  Finding finding;
  const Distribution* distribution;
  std::uint64_t index;
};

struct CheckResult {
  const Check* check;
  std::uint64_t configurations = 0;  // that it says something of
  std::optional<Worst> worst;

  bool Passes() const { return !worst || worst->finding.violation <= 1; }
  // Of the results over two sets of configurations, in any order.
  void Merge(const CheckResult& other);
};

struct EnergyResult {
  Subject subject;
  std::uint64_t drawn = 0, active = 0;
  std::vector<CheckResult> checks;  // those that apply
};

struct Result {
  Plan plan;
  std::vector<EnergyResult> energies;
  std::optional<double> load_before;
  bool partial = false;
};

// The same for any number of threads. Stops at the next block when interrupted (progress.hpp); the
// result then covers what is complete, and says that it is partial.
Result RunChecks(const Plan& plan, Progress& progress);

// After results/schema.json.
nlohmann::ordered_json ToJson(const Result& result, const std::vector<std::string>& command);

// A line for each check and energy, readable at 100 columns.
std::string ToTable(const Result& result);

// A line for each check that fails, with the command that replays it; empty if all pass.
std::string Failures(const Result& result);

}  // namespace definite::verify
