#pragma once

// How fast rows are against each other and against the machine (docs/protocol.md, section 3):
// competitors interleaved in random order over the same configurations, into outputs in L1, L2 or
// memory, on one thread or more, with the floor of each beside it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/harness/bootstrap.hpp"
#include "benchmarks/harness/progress.hpp"
#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/speed/roofline.hpp"
#include "benchmarks/speed/stages.hpp"
#include "kernels/kernel.hpp"

namespace definite {

struct SpeedPlan {
  std::vector<const KernelRow*> rows;  // packed ones and others
  const Distribution* distribution = nullptr;
  std::uint64_t seed = 42;
  std::vector<Level> levels = {Level::kL1, Level::kL2, Level::kMemory};
  std::vector<int> threads = {1, 2};
  int rounds = 15;
  // Of the jobs and the assemblies of stages.hpp; none if 0.
  std::int64_t configurations = 0, elements = 0;
};

// The least time that a configuration can take on one core.
struct Floor {
  Operations operations;                            // of all that were counted
  std::int64_t counted = 0;                         // configurations
  double arithmetic = 0, division = 0, stores = 0;  // seconds that each would take alone

  double Seconds() const;
  std::string_view Binds() const;  // "arithmetic", "division" or "stores"
};

struct SpeedRow {
  const KernelRow* row;
  Level level;
  int threads;
  std::vector<double> seconds;  // per configuration, of each round
  std::optional<Floor> floor;   // where the row counts its operations
  // Same energy, level, threads and round: theirs over ours.
  std::optional<MedianEstimate> to_numeric, to_gauss_newton;
};

struct SpeedResult {
  SpeedPlan plan;
  Roofline roofline;
  std::optional<double> load_before;
  bool noisy = false;  // other work had its share of the machine
  std::vector<SpeedRow> rows;
  std::vector<JobTime> jobs;
  std::vector<AssemblyTime> assemblies;
  bool partial = false;
};

// Rounds already begun are finished when interrupted.
SpeedResult RunSpeed(const SpeedPlan& plan, Progress& progress);

std::string_view LevelName(Level level);

nlohmann::ordered_json ToJson(const SpeedResult& result, const std::vector<std::string>& command);
std::string ToTable(const SpeedResult& result);  // at 100 columns

// Of a result as JSON, so that a published file gives the same again: what analytic over
// Gauss-Newton depends on, all rows, jobs, assemblies. Throws where it lacks a row that it needs.
std::string ToMarkdown(const nlohmann::ordered_json& result);

}  // namespace definite
