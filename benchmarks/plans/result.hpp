#pragma once

// What tables read of a result as JSON (results/schema.json), and how they show it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace definite {

// A number, or "inf", "-inf", "nan".
double NumberOf(const nlohmann::ordered_json& value);

// A figure's entry, such as distance / median; nothing if there was none to measure.
std::optional<double> Entry(const nlohmann::ordered_json& row, const std::string& figure,
                            const std::string& entry);

// Two digits in at most seven characters; "-" if there is none.
std::string Short(const std::optional<double>& value);

// "-" if there is none.
std::string Show(const std::optional<double>& value, const char* format);
std::string Percent(const nlohmann::ordered_json& fraction);

// Lines of at most 98 columns after an empty one.
std::string Paragraph(const std::string& text);

nlohmann::ordered_json Claim(const std::string& claim, const std::string& theirs,
                             const std::string& ours, const std::string& verdict,
                             const std::string& reason);

// A paragraph on the machine and the build.
std::string Provenance(const nlohmann::ordered_json& result);

}  // namespace definite
