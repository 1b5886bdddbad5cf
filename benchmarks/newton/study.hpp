#pragma once

// Problems solved by rivals, and how they compare.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/newton/solver.hpp"

namespace definite::newton {

// The row by which a filter is run: in lanes where it can be.
const KernelRow* RowOf(const EnergyRow& energy, std::string_view filter);

// The filters that are run unless told otherwise.
std::vector<std::string> DefaultFilters();

struct Entry {
  const KernelRow* row;
  Descent run;
};

// One problem, and a run for each rival that has a row for its energy.
struct Contest {
  Problem problem;
  std::string meaning;
  std::vector<Entry> entries;
};

// `advance` is called after each filter. Ends with a run that was interrupted.
void RunContest(const std::vector<std::string>& filters, const Settings& settings,
                const std::function<void()>& advance, Contest& contest);

// Problems that a filter solved within tau times the least of all filters. It has not solved one
// that it left in a saddle point, nor one for whose energy it has no row. Source: Dolan and Moré
// 2002.
struct Profile {
  double tolerance;
  enum Measure { kIterations, kSeconds } measure;
  struct Line {
    std::string filter;
    std::vector<int> solved;  // for each of kTaus
  };
  std::vector<Line> lines;
};
inline constexpr double kTaus[] = {1, 1.5, 2, 5};

// Iterations and seconds for each tolerance; filters in their order, those that ran.
std::vector<Profile> ProfilesOf(std::span<const Contest> contests,
                                const std::vector<std::string>& filters,
                                const std::vector<double>& tolerances);

}  // namespace definite::newton
