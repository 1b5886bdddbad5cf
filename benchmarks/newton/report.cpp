#include "benchmarks/newton/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/newton/catalogue.hpp"

namespace definite::newton {

namespace {

using Json = nlohmann::ordered_json;

std::string_view Describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::kConverged:
      return "converged";
    case Outcome::kNotDescending:
      return "the energy does not fall along the step";
    case Outcome::kSingular:
      return "the matrix has no factorisation";
    case Outcome::kLineSearchFailed:
      return "no length of the step brings a decrease";
    case Outcome::kIterationLimit:
      return "not converged at the last iteration allowed";
    case Outcome::kInterrupted:
      return "interrupted";
  }
  return {};
}

// "-" where the tolerance was not met.
std::string IterationsTo(const Descent& run, std::size_t tolerance) {
  return tolerance < run.reached.size() ? fmt::format("{}", run.reached[tolerance].iterations)
                                        : "-";
}

std::size_t VerticesOf(const Problem& problem) {
  return problem.fixed.size() / static_cast<std::size_t>(problem.energy->dimension);
}
std::ptrdiff_t FreeOf(const Problem& problem) { return std::ranges::count(problem.fixed, false); }

// JSON has no NaN and no infinity.
Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }
double Nanoseconds(double seconds) { return 1e9 * seconds; }

Json ToJson(const Seconds& seconds) {
  return {{"ns_hessians", Nanoseconds(seconds.hessians)},
          {"ns_assembly", Nanoseconds(seconds.assembly)},
          {"ns_solution", Nanoseconds(seconds.solution)},
          {"ns_line_search", Nanoseconds(seconds.line_search)},
          {"ns_gradients", Nanoseconds(seconds.gradients)}};
}

Json ToJson(const Entry& entry, const Settings& settings) {
  const Descent& run = entry.run;
  Json reached = Json::array(), history = Json::array();
  for (std::size_t t = 0; t < settings.tolerances.size(); ++t) {
    const bool met = t < run.reached.size();
    reached.push_back({{"tolerance", settings.tolerances[t]},
                       {"iterations", met ? Json(run.reached[t].iterations) : Json()},
                       {"ns", met ? Json(Nanoseconds(run.reached[t].seconds)) : Json()}});
  }
  for (const Iteration& i : run.iterations) {
    history.push_back({{"value", NumberOrNull(i.value)},
                       {"gradient", NumberOrNull(i.gradient)},
                       {"step", i.step},
                       {"negative_pivots", i.negative_pivots}});
  }
  return {{"filter", entry.row->filter},
          {"row", entry.row->name},
          {"outcome", NameOf(run.outcome)},
          {"iterations", run.iterations.size()},
          {"factorizations", run.factorizations},
          {"indefinite", run.indefinite},
          {"evaluations", run.evaluations},
          {"solver_iterations", run.solver_iterations},
          {"value", NumberOrNull(run.value)},
          {"gradient", NumberOrNull(run.gradient)},
          {"falling", run.falling},
          {"reached", reached},
          {"timing", ToJson(run.seconds)},
          {"history", history}};
}

Json ToJson(const Profile& profile, std::size_t contests) {
  Json lines = Json::array();
  for (const Profile::Line& line : profile.lines) {
    Json shares = Json::array();
    for (const int solved : line.solved) {
      shares.push_back(static_cast<double>(solved) / static_cast<double>(contests));
    }
    lines.push_back({{"filter", line.filter}, {"shares", shares}});
  }
  return {{"tolerance", profile.tolerance},
          {"measure", profile.measure == Profile::kIterations ? "iterations" : "time"},
          {"taus", kTaus},
          {"filters", lines}};
}

}  // namespace

std::string ToTable(const Contest& contest, const Settings& settings) {
  const Problem& problem = contest.problem;
  std::string table = fmt::format("{}: {}\n  {}: {} elements, {} vertices, {} degrees of freedom\n",
                                  problem.name, contest.meaning, problem.energy->name,
                                  WithCommas(static_cast<std::uint64_t>(problem.Elements())),
                                  WithCommas(VerticesOf(problem)),
                                  WithCommas(static_cast<std::uint64_t>(FreeOf(problem))));
  table += fmt::format("  {:<18}", "iterations to");
  for (const double tolerance : settings.tolerances) table += fmt::format("{:>6.0e}", tolerance);
  table += fmt::format("{:>6}{:>6}{:>7}{:>7}{:>7}{:>7}{:>8}{:>12}{:>7}\n", "fact.", "indef",
                       "hess s", "sum s", "solve", "search", "all s", "energy", "grad.");
  for (const Entry& entry : contest.entries) {
    const Descent& run = entry.run;
    table += fmt::format("  {:<18}", entry.row->filter);
    for (std::size_t t = 0; t < settings.tolerances.size(); ++t) {
      table += fmt::format("{:>6}", IterationsTo(run, t));
    }
    const Seconds& s = run.seconds;
    table += fmt::format("{:>6}{:>6}{:>7.3f}{:>7.3f}{:>7.3f}{:>7.3f}{:>8.3f}{:>12.5g}{:>7.0e}\n",
                         run.factorizations, run.indefinite, s.hessians, s.assembly, s.solution,
                         s.line_search, s.Sum(), run.value, run.gradient);
  }
  for (const Entry& entry : contest.entries) {
    if (entry.run.outcome == Outcome::kConverged) {
      if (entry.run.falling > 0) {
        table += fmt::format("  {} ends in a saddle point, negative eigenvalues: {}\n",
                             entry.row->filter, entry.run.falling);
      }
      continue;
    }
    table += fmt::format("  {} after {} iterations: {}\n", entry.row->filter,
                         entry.run.iterations.size(), Describe(entry.run.outcome));
  }
  return table + "\n";
}

std::string ProfileTable(std::span<const Profile> profiles, std::size_t contests) {
  std::string table;
  // Iterations and seconds of one tolerance, side by side.
  for (std::size_t i = 0; i + 1 < profiles.size(); i += 2) {
    const Profile &iterations = profiles[i], &seconds = profiles[i + 1];
    table += fmt::format("share of {} problems solved to {:.0e} within tau of the best\n", contests,
                         iterations.tolerance);
    table += fmt::format("  {:<18}{:<12}", "", "iterations:");
    for (const double tau : kTaus) table += fmt::format("{:>7g}", tau);
    table += fmt::format(" {:<10}", "seconds:");
    for (const double tau : kTaus) table += fmt::format("{:>7g}", tau);
    table += "\n";
    for (std::size_t line = 0; line < iterations.lines.size(); ++line) {
      table += fmt::format("  {:<18}{:12}", iterations.lines[line].filter, "");
      const auto add = [&](const Profile& profile) {
        for (const int solved : profile.lines[line].solved) {
          table += fmt::format("{:>5.0f} %", 100.0 * solved / static_cast<double>(contests));
        }
      };
      add(iterations);
      table += fmt::format("{:11}", "");
      add(seconds);
      table += "\n";
    }
    table += "\n";
  }
  return table;
}

Json ToJson(std::span<const Contest> contests, std::size_t all, const Settings& settings,
            std::span<const Profile> profiles) {
  Json json = {{"solver", settings.solver == LinearSolver::kLdlt ? "ldlt" : "conjugate_gradients"},
               {"tolerances", settings.tolerances},
               {"most_iterations", settings.most_iterations},
               {"all_problems", all},
               {"problems", Json::array()},
               {"profiles", Json::array()}};
  for (const Contest& contest : contests) {
    const Problem& problem = contest.problem;
    Json one = {{"name", problem.name},
                {"meaning", contest.meaning},
                {"energy", problem.energy->name},
                {"elements", problem.Elements()},
                {"vertices", VerticesOf(problem)},
                {"degrees_of_freedom", FreeOf(problem)},
                {"runs", Json::array()}};
    for (const Entry& entry : contest.entries) one["runs"].push_back(ToJson(entry, settings));
    json["problems"].push_back(std::move(one));
  }
  for (const Profile& profile : profiles) {
    json["profiles"].push_back(ToJson(profile, contests.size()));
  }
  return json;
}

std::string ProblemTable() {
  std::string table;
  for (const Template& of : AllProblems()) {
    table += fmt::format("{:<18}{}\n", of.name, of.meaning);
  }
  return table;
}

}  // namespace definite::newton
