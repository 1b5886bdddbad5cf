#pragma once

// A sweep drives rows over the configurations 0 .. count-1 of a distribution: a timed pass that
// never checks, then a checked pass that is never timed (docs/protocol.md).

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/harness/blocks.hpp"
#include "benchmarks/harness/bootstrap.hpp"
#include "benchmarks/harness/examine.hpp"
#include "benchmarks/harness/progress.hpp"
#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/statistics.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// At most how many configurations of a sweep are looked at how closely (examine.hpp); by default
// what docs/protocol.md says.
struct Samples {
  std::uint64_t definition = 1'000'000, spectrum = 100'000, truth = 10'000;
};

struct SweepPlan {
  std::vector<const KernelRow*> rows;
  const Distribution* distribution = nullptr;
  std::vector<ParameterValue> overrides;  // of the energies that have such a parameter
  Samples samples;
  std::uint64_t seed = 42;
  std::uint64_t count = 10'000'000;
  Shard shard;  // only these of the count
  int threads = 1;
  bool timing = true, checks = true;
  bool worst_cases = true;  // looked at again in float128
};

// Seconds per configuration of one row, a number for each round: of all configurations, and of
// those where the energy acts (a round without any is left out).
struct RowTiming {
  std::vector<double> all, active;
};

// What the checked pass knows of one row, of the configurations of some blocks; that of more blocks
// is the merger of both.
struct RowStatistics {
  Figure distance, excess, psd_defect, majorises, relabelling, rounding, conditioned_rounding;
  std::array<std::uint64_t, kVerdictCount> verdicts{};
  std::uint64_t defined = 0;  // configurations held against the filter's definition
  std::uint64_t flips = 0, flip_checks = 0;
  std::uint64_t checksum = 0;                // of all outputs, bit for bit
  std::map<Property, std::uint64_t> broken;  // property -> smallest index

  void Add(const RowFigures& figures, std::uint64_t index);
  // Only what float128 says of a configuration.
  void AddTruth(const RowFigures& figures, std::uint64_t index);
  void Merge(const RowStatistics& other);
};

// What holds for the configurations, whatever the filter.
struct EnergyStatistics {
  std::uint64_t count = 0, active = 0, indefinite = 0, out_of_domain = 0;
  Figure value_rounding, gradient_rounding;

  void Add(const ConfigurationFigures& figures, std::uint64_t index);
  void Merge(const EnergyStatistics& other);
};

struct RowResult {
  const KernelRow* row;
  RowTiming timing;
  RowStatistics statistics;
  // The worst cases of all rows in float128, by index; what is not in the statistics already.
  std::map<std::uint64_t, RowFigures> worst_cases;
  RowStatistics of_worst_cases;
};

struct EnergyResult {
  const EnergyRow* energy;
  EnergyStatistics statistics;
  std::vector<RowResult> rows;
  // The blocks that were checked, by their first configuration, with a sum over the bits of all
  // outputs.
  std::map<std::uint64_t, std::uint64_t> blocks;
  // Of the timed pass, over all threads: with less processor time than wall time, other work had
  // its share of the machine.
  double timed_cpu = 0, timed_wall = 0;
};

struct SweepResult {
  SweepPlan plan;
  std::vector<EnergyResult> energies;
  std::optional<double> load_before;  // load average of one minute
  bool partial = false;
};

// Of nothing yet.
SweepResult Prepare(const SweepPlan& plan);

// What a long run is told besides.
struct RunControl {
  const SweepResult* earlier = nullptr;  // of the same plan: its blocks are not checked again
  // Called between blocks with what is complete, every so often.
  std::function<void(const SweepResult&)> checkpoint;
  double checkpoint_seconds = 20;
};

// Runs both passes. Stops at the next block when interrupted (progress.hpp); what is complete by
// then are the first blocks of each energy, and the result says that it is partial.
SweepResult RunSweep(const SweepPlan& plan, Progress& progress, const RunControl& control = {});

// Runs the timed passes of all plans, then the checked ones; the progress is that of all.
std::vector<SweepResult> RunSweeps(std::span<const SweepPlan> plans, Progress& progress);

// Whether all blocks of all energies were checked, those of other shards too.
bool IsWhole(const SweepResult& result);

// Whether a row is looked at only where definitions are (Samples): an eigendecomposition of each
// matrix by itself takes microseconds, and is what the others are compared with.
bool IsSampled(const KernelRow& row);

// How closely configuration `index` of `count` is looked at.
Depth DepthOf(std::uint64_t index, std::uint64_t count, const Samples& samples = {});

}  // namespace definite
