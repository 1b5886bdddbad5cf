#include "benchmarks/compare/paired.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "benchmarks/harness/report.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;
using Medians = std::map<std::string, double>;

std::string OutputOf(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (!pipe) throw CompareError("cannot start: " + command);
  std::ostringstream text;
  std::array<char, 65536> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.write(buffer.data(), static_cast<std::streamsize>(n));
  }
  const int status = pclose(pipe);
  // Ctrl-C ends the program too.
  if (!Interrupted() && (!WIFEXITED(status) || WEXITSTATUS(status) != 0)) {
    throw CompareError(fmt::format("this failed, with {}:\n  {}",
                                   WIFEXITED(status)
                                       ? fmt::format("exit code {}", WEXITSTATUS(status))
                                       : fmt::format("signal {}", WTERMSIG(status)),
                                   command));
  }
  return text.str();
}

Medians Run(const std::string& program, const PairedPlan& plan) {
  std::string command = ForShell(program) + " sweep --no-checks --threads 1 --json -";
  for (const std::string& word : plan.arguments) command += fmt::format(" {}", ForShell(word));
  const Json result = Json::parse(OutputOf(command), nullptr, false);
  if (Interrupted()) return {};
  if (result.is_discarded()) throw CompareError("this wrote no JSON:\n  " + command);
  Medians medians;
  for (const Timed& timed : TimesOf(result)) {
    medians[timed.key] = EstimateMedian(timed.ns)->median;
  }
  return medians;
}

std::vector<Timed> InOrder(const std::map<std::string, std::vector<double>>& times, int rounds) {
  std::vector<Timed> list;
  for (const auto& [key, ns] : times) {
    if (static_cast<int>(ns.size()) == rounds) list.push_back({key, ns});
  }
  return list;
}

}  // namespace

PairedTimes RunPaired(const PairedPlan& plan, Progress& progress) {
  std::map<std::string, std::vector<double>> times[2];
  progress.Start("rounds", static_cast<std::uint64_t>(plan.rounds));
  PairedTimes result;
  for (int round = 0; round < plan.rounds; ++round) {
    Medians sums[2];
    for (const int side : {0, 1, 1, 0}) {
      for (const auto& [key, ns] : Run(side ? plan.now : plan.base, plan)) {
        sums[side][key] += 0.5 * std::log(ns);
      }
      if (Interrupted()) {
        result.partial = true;
        return result;
      }
    }
    for (const int side : {0, 1}) {
      for (const auto& [key, sum] : sums[side]) times[side][key].push_back(std::exp(sum));
    }
    progress.Advance(1);
  }
  progress.Finish();
  result.base = InOrder(times[0], plan.rounds);
  result.now = InOrder(times[1], plan.rounds);
  return result;
}

}  // namespace definite
