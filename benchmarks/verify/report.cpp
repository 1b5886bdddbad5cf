#include "benchmarks/harness/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/verify/verify.hpp"

namespace definite::verify {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity and no NaN.
Json Number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : "inf";
}

// "absolute/f64", without the energy's name.
std::string ShortName(const KernelRow& row) { return fmt::format("{}/{}", row.filter, row.scalar); }

Json ToJson(const CheckResult& result, const EnergyRow& energy) {
  Json json = {{"check", result.check->name},
               {"energy", energy.name},
               {"configurations", result.configurations},
               {"passes", result.Passes()},
               {"worst", nullptr}};
  if (result.worst) {
    json["worst"] = {{"violation", Number(result.worst->finding.violation)},
                     {"distribution", result.worst->distribution->name},
                     {"index", result.worst->index},
                     {"row", nullptr}};
    if (const KernelRow* row = result.worst->finding.row) json["worst"]["row"] = row->name;
  }
  return json;
}

std::string ReplayLine(const Result& result, const EnergyRow& energy, const Worst& worst) {
  return fmt::format("definite verify --kernels '{}/*' --distribution {} --seed {} --index {}",
                     energy.name, worst.distribution->name, result.plan.seed, worst.index);
}

// The names of what fails, and the checks that were of use.
std::string Summary(const Result& result) {
  std::size_t failed = 0, lines = 0;
  std::set<const KernelRow*> rows;
  for (const EnergyResult& energy : result.energies) {
    rows.insert(energy.subject.rows.begin(), energy.subject.rows.end());
    for (const CheckResult& check : energy.checks) {
      ++lines;
      failed += !check.Passes();
    }
  }
  return fmt::format("{} energies with {} rows, {} checks of them: {}\n", result.energies.size(),
                     rows.size(), lines,
                     failed ? fmt::format("{} fail", failed) : std::string("all pass"));
}

}  // namespace

Json ToJson(const Result& result, const std::vector<std::string>& command) {
  Json json = ResultHead(command, result.plan.seed, result.partial, result.load_before);
  Json& verification = json["verification"];
  verification = {{"first", result.plan.first}, {"count", result.plan.count}};
  for (const Distribution* distribution : result.plan.distributions) {
    verification["distributions"].push_back(distribution->name);
  }
  for (const Check& check : result.plan.checks) {
    verification["says"][std::string(check.name)] = check.says;
  }
  verification["energies"] = Json::array();
  verification["checks"] = Json::array();
  for (const EnergyResult& energy : result.energies) {
    Json of_energy = {{"energy", energy.subject.energy->name},
                      {"drawn", energy.drawn},
                      {"active", energy.active},
                      {"rows", Json::array()}};
    for (const KernelRow* row : energy.subject.rows) of_energy["rows"].push_back(row->name);
    verification["energies"].push_back(of_energy);
    for (const CheckResult& check : energy.checks) {
      verification["checks"].push_back(ToJson(check, *energy.subject.energy));
    }
  }
  return json;
}

std::string ToTable(const Result& result) {
  std::string table;
  for (const EnergyResult& energy : result.energies) {
    table += fmt::format("{}\n{} rows; {} drawn, {} active\n\n", energy.subject.energy->name,
                         energy.subject.rows.size(), WithCommas(energy.drawn),
                         WithCommas(energy.active));
    table += fmt::format("{:<24}{:>9}{:>16}  {}\n", "check", "held at", "worst / bound", "where");
    for (const CheckResult& check : energy.checks) {
      table += fmt::format("{:<24}{:>9}", check.check->name, WithCommas(check.configurations));
      if (check.worst) {
        table += fmt::format("{:>16.2g}  {} {}", check.worst->finding.violation,
                             check.worst->distribution->name, check.worst->index);
        if (const KernelRow* row = check.worst->finding.row)
          table += fmt::format(" {}", ShortName(*row));
        if (!check.Passes()) table += "  FAILS";
      } else {
        table += fmt::format("{:>16}", "-");
      }
      table += "\n";
    }
    table += "\n";
  }
  return table + Summary(result);
}

std::string Failures(const Result& result) {
  std::string lines;
  for (const EnergyResult& energy : result.energies) {
    for (const CheckResult& check : energy.checks) {
      if (check.Passes()) continue;
      const KernelRow* row = check.worst->finding.row;
      lines += fmt::format("{}: {} fails, {:.2g} times its bound ({}):\n  {}\n",
                           row ? row->name : energy.subject.energy->name, check.check->name,
                           check.worst->finding.violation, check.check->says,
                           ReplayLine(result, *energy.subject.energy, *check.worst));
    }
  }
  return lines;
}

}  // namespace definite::verify
