#include "benchmarks/newton/study.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace definite::newton {

const KernelRow* RowOf(const EnergyRow& energy, std::string_view filter) {
  for (const char* scalar : {"f64x8", "f64"}) {
    std::string name = energy.name;
    name.append("/").append(filter).append("/").append(scalar);
    if (const KernelRow* row = FindKernel(name)) return row;
  }
  return nullptr;
}

std::vector<std::string> DefaultFilters() {
  return {"none",    "gauss_newton", "analytic", "numeric_frame",
          "numeric", "nearest",      "absolute", "stomakhin"};
}

void RunContest(const std::vector<std::string>& filters, const Settings& settings,
                const std::function<void()>& advance, Contest& contest) {
  for (const std::string& filter : filters) {
    const KernelRow* const row = RowOf(*contest.problem.energy, filter);
    if (row == nullptr) continue;
    contest.entries.push_back({row, Solve(contest.problem, *row, settings)});
    if (contest.entries.back().run.outcome == Outcome::kInterrupted) return;
    advance();
  }
}

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// What it took to meet a tolerance.
double Cost(const Descent& run, std::size_t tolerance, Profile::Measure measure) {
  if (tolerance >= run.reached.size() || run.falling > 0) return kNever;
  const Reached& reached = run.reached[tolerance];
  return measure == Profile::kIterations ? reached.iterations : reached.seconds;
}

double LeastCost(const Contest& contest, std::size_t tolerance, Profile::Measure measure) {
  double least = kNever;
  for (const Entry& entry : contest.entries)
    least = std::min(least, Cost(entry.run, tolerance, measure));
  return least;
}

Profile::Line LineOf(std::span<const Contest> contests, const std::string& filter,
                     std::size_t tolerance, Profile::Measure measure) {
  Profile::Line line{filter, {}};
  for (const Contest& contest : contests) {
    const double least = LeastCost(contest, tolerance, measure);
    for (const Entry& entry : contest.entries) {
      if (entry.row->filter != filter) continue;
      line.solved.resize(std::size(kTaus));
      const double cost = Cost(entry.run, tolerance, measure);
      for (std::size_t t = 0; t < std::size(kTaus); ++t) {
        line.solved[t] += cost < kNever && cost <= kTaus[t] * least;
      }
    }
  }
  return line;
}

}  // namespace

std::vector<Profile> ProfilesOf(std::span<const Contest> contests,
                                const std::vector<std::string>& filters,
                                const std::vector<double>& tolerances) {
  std::vector<Profile> profiles;
  for (std::size_t t = 0; t < tolerances.size(); ++t) {
    for (const auto measure : {Profile::kIterations, Profile::kSeconds}) {
      Profile& profile = profiles.emplace_back(Profile{tolerances[t], measure, {}});
      for (const std::string& filter : filters) {
        Profile::Line line = LineOf(contests, filter, t, measure);
        if (!line.solved.empty()) profile.lines.push_back(std::move(line));
      }
    }
  }
  return profiles;
}

}  // namespace definite::newton
