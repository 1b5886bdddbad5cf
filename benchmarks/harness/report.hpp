#pragma once

// A sweep's result as JSON (results/schema.json) and as a table for people.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "benchmarks/harness/sweep.hpp"

namespace definite {

// How much is written. kBrief is for tables over many energies: distance, excess, PSD defect and
// relabelling, worst cases by their index alone. kCanonical is what is the same however a sweep was
// shared out: its plan instead of the command, no machine, no timing, and nothing that float128
// found in worst cases, since a part has others than the whole.
enum class Detail { kBrief, kSummaries, kWithHistograms, kCanonical };

nlohmann::ordered_json ToJson(const SweepResult& result, const std::vector<std::string>& command,
                              Detail detail = Detail::kWithHistograms);
// What a result of any other command begins with: no rows, and room for what it measured.
nlohmann::ordered_json ResultHead(const std::vector<std::string>& command, std::uint64_t seed,
                                  bool partial, std::optional<double> load_before = std::nullopt,
                                  bool noisy = false);
// The rows of several sweeps, in their order.
nlohmann::ordered_json ToJson(std::span<const SweepResult> results,
                              const std::vector<std::string>& command, Detail detail);

// What of a file on record was read; null for what is drawn.
nlohmann::ordered_json RecordedToJson(const Distribution& distribution);

// JSON as text: in one line with histograms; else one key a line, but each row in one line if
// brief.
std::string Dump(const nlohmann::ordered_json& json, Detail detail);

// Readable at 100 columns.
std::string ToTable(const SweepResult& result);

// The command that shows one configuration whole.
std::string ReplayCommand(const SweepPlan& plan, const KernelRow& row, std::uint64_t index);

// A line for each promise that a row broke, with its replay command; empty if none.
std::string BrokenPromises(const SweepResult& result);

// ", side = -1, eps = 0.5": the energy's parameters that the plan sets.
std::string Describe(const SweepPlan& plan, const EnergyRow& energy);

// A word that the shell takes for itself, in quotes where it must be.
std::string ForShell(const std::string& word);

// 3.25 as "0x1.ap+1": read back exactly by any strtod.
std::string HexFloat(double value);

// 10000000 as "10,000,000".
std::string WithCommas(std::uint64_t value);

}  // namespace definite
