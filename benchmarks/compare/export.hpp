#pragma once

// Results as other tools read them.

#include <nlohmann/json.hpp>

namespace definite {

// The format customSmallerIsBetter of github-action-benchmark: a list of {"name", "unit", "value",
// "range", "extra"}, a line for each timing of a result of sweep or speed.
nlohmann::ordered_json ToCustomSmallerIsBetter(const nlohmann::ordered_json& result);

}  // namespace definite
