#pragma once

// A sweep's result as JSON (results/schema.json) and as a table for people.

#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/harness/sweep.hpp"

namespace definite {

enum class Detail { kSummaries, kWithHistograms };

nlohmann::ordered_json ToJson(const SweepResult& result, const std::vector<std::string>& command,
                              Detail detail = Detail::kWithHistograms);

// Readable at 100 columns.
std::string ToTable(const SweepResult& result);

// The command that shows one configuration whole.
std::string ReplayCommand(const SweepPlan& plan, const KernelRow& row, std::uint64_t index);

// A line for each promise that a row broke, with its replay command; empty if none.
std::string BrokenPromises(const SweepResult& result);

// 3.25 as "0x1.ap+1": read back exactly by any strtod.
std::string HexFloat(double value);

// 10000000 as "10,000,000".
std::string WithCommas(std::uint64_t value);

}  // namespace definite
