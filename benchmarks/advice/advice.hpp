#pragma once

// Which filter fits configurations on record: the cheapest that is PSD in all of them, and near
// enough to the nearest PSD matrix.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/advice/degeneracies.hpp"
#include "benchmarks/harness/sweep.hpp"

namespace definite {

// What a solver would choose between: the filters of an energy that are no variants of others nor
// baselines, on lanes where they have them.
std::vector<const KernelRow*> Candidates(const EnergyRow& energy);

// Checks all of a file, and times it: a short one again and again, for long enough.
SweepResult RunForAdvice(const SweepPlan& plan, Progress& progress);

struct Advice {
  double tolerance;         // of the distance to nearest, in 99 of 100 active configurations
  const RowResult* chosen;  // null if no row will do
  std::string reason;       // in one sentence
  std::vector<DegeneracyCount> degeneracies;  // of the active ones and those outside the domain
};

// What is wrong with a row for someone with this tolerance: empty, or half a sentence.
std::string Objection(const RowResult& row, double tolerance);

// Of a sweep of one energy, with times.
Advice AdviseOn(const SweepResult& result, double tolerance);

// "advice" of results/schema.json.
nlohmann::ordered_json ToJson(const Advice& advice, const SweepResult& result);

// Readable at 100 columns.
std::string ToTable(const Advice& advice, const SweepResult& result);

}  // namespace definite
