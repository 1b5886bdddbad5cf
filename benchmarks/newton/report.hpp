#pragma once

// Contests as tables at 100 columns, and as JSON (results/schema.json, "newton").

#include <nlohmann/json.hpp>

#include "benchmarks/newton/study.hpp"

namespace definite::newton {

std::string ToTable(const Contest& contest, const Settings& settings);
std::string ProfileTable(std::span<const Profile> profiles, std::size_t contests);

// `all` is how many contests were asked for.
nlohmann::ordered_json ToJson(std::span<const Contest> contests, std::size_t all,
                              const Settings& settings, std::span<const Profile> profiles);

// The problems with what they are.
std::string ProblemTable();

}  // namespace definite::newton
