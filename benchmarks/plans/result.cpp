#include "benchmarks/plans/result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "benchmarks/plans/markdown.hpp"

namespace definite {

namespace {
using Json = nlohmann::ordered_json;
}

double NumberOf(const Json& value) {
  if (value.is_string()) {
    return value == "nan" ? std::numeric_limits<double>::quiet_NaN()
                          : std::numeric_limits<double>::infinity();
  }
  return value;
}

std::optional<double> Entry(const Json& row, const std::string& figure, const std::string& entry) {
  const Json& f = row.at("accuracy").at(figure);
  if (f.is_null() || f.at(entry).is_null()) return std::nullopt;  // no value, or none but NaN
  return NumberOf(entry == "max" ? f.at("max").at("value") : f.at(entry));
}

std::string Show(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string Short(const std::optional<double>& value) {
  if (!value) return "-";
  const double size = std::abs(*value);
  if (size == 0) return "0";
  if (size < 1e-3 || size >= 1e4) return fmt::format("{:.1e}", *value);
  return fmt::format(fmt::runtime(size < 99.5 ? "{:.2g}" : "{:.0f}"), *value);
}

std::string Percent(const Json& fraction) {
  return fraction.is_null() ? "-" : fmt::format("{:.4g}", 100 * fraction.get<double>());
}

std::string Paragraph(const std::string& text) {
  return fmt::format("\n{}", Wrapped(text, 98, ""));
}

Json Claim(const std::string& claim, const std::string& theirs, const std::string& ours,
           const std::string& verdict, const std::string& reason) {
  return {{"claim", claim},
          {"theirs", theirs},
          {"ours", ours},
          {"verdict", verdict},
          {"reason", reason}};
}

std::string Provenance(const Json& result) {
  const Json& machine = result.at("machine");
  const Json& build = result.at("build");
  const auto known = [](const Json& value) {
    return value.is_null()     ? "unknown"
           : value.is_string() ? value.get<std::string>()
                               : fmt::format("{:.2f}", value.get<double>());
  };
  return Paragraph(fmt::format(
      "Machine: {}, {} cores, load {}{}. Build: {}, {}, {}, Eigen {}, commit {}.",
      known(machine.at("cpu")), machine.at("cores").get<int>(), known(machine.at("load_average")),
      machine.at("noisy").get<bool>() ? " (noisy)" : "", build.at("compiler").get<std::string>(),
      build.at("flags").get<std::string>(), build.at("isa").get<std::string>(),
      build.at("eigen").get<std::string>(), build.at("commit").get<std::string>()));
}

}  // namespace definite
