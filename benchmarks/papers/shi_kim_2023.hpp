#pragma once

// Shi & Kim 2023, "A Unified Analysis of Penalty-Based Collision Energies": its Table 1 and the
// claims around it, held against a sweep of ours. Works on results as JSON, so that a published
// file gives the same tables again.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace definite {

struct ShiKim2023 {
  static constexpr const char* kName = "shi-kim-2023";
  static constexpr const char* kDistribution = "paper";

  // Globs of the rows that the tables need.
  static std::vector<std::string> Rows();

  // [{"claim", "theirs", "ours", "verdict", "reason"}], verdict one of "reproduced", "qualified",
  // "not reproduced".
  static nlohmann::ordered_json Claims(const nlohmann::ordered_json& result);

  // The tables and the claims as Markdown, readable as it stands at 100 columns.
  static std::string Markdown(const nlohmann::ordered_json& result);
};

}  // namespace definite
