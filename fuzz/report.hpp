#pragma once

// A run's cells as a table, and its findings in words and as JSON (results/schema.json, "fuzz").

#include <string>
#include <vector>

#include "fuzz/findings.hpp"

namespace definite::fuzz {

// A line for each filter: what share of its cases fared how, readable at 100 columns.
std::string ToTable(const Plan& plan, const std::vector<nlohmann::ordered_json>& cells);

// A finding with its simplest example; `example` is empty for a crash.
struct Reported {
  Finding finding;
  Example example;
};

std::string ToText(const Reported& reported);
nlohmann::ordered_json ToJson(const Plan& plan, std::size_t all_cells,
                              const std::vector<nlohmann::ordered_json>& cells,
                              const std::vector<Reported>& findings);

// A result without its cells, but with what docs/where-filters-fail.md says of them.
nlohmann::ordered_json Summary(nlohmann::ordered_json result);

// docs/where-filters-fail.md, of a whole result or its summary.
std::string ToMarkdown(const nlohmann::ordered_json& result);

// What the page draws of a result's "fuzz": for each energy, family and filter, decade by decade,
// the worst verdict and the largest errors; null where there is none.
nlohmann::ordered_json DegeneracyMaps(const nlohmann::ordered_json& fuzz);

nlohmann::ordered_json HexNumbers(const std::vector<double>& numbers);

// The families with their stencils.
std::string FamilyTable();

}  // namespace definite::fuzz
