// definite newton: Newton's method on meshes, once with each filter.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/newton/catalogue.hpp"
#include "benchmarks/newton/cut.hpp"
#include "benchmarks/newton/obj.hpp"
#include "benchmarks/newton/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct NewtonOptions {
  std::vector<std::string> problems = {"all"}, energies = {"symmetric_dirichlet"}, filters;
  std::vector<std::string> tolerances = {"1e-4", "1e-8"};
  std::string most_iterations = "1000", solver = "ldlt", seed = "42";
  std::optional<std::string> obj, json;
  bool quick = false, list = false;
};

// At most two, which a table has room for.
std::vector<double> TolerancesOf(const NewtonOptions& options) {
  std::vector<double> tolerances;
  for (const std::string& word : options.tolerances) {
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end || !(value > 0 && value < 1)) {
      throw UsageError(
          fmt::format("--tolerance '{}': expected a number between 0 and 1, such as 1e-6", word));
    }
    tolerances.push_back(value);
  }
  std::ranges::sort(tolerances, std::greater());
  if (tolerances.size() > 2) {
    throw UsageError(fmt::format("--tolerance: expected at most 2, found {}", tolerances.size()));
  }
  return tolerances;
}

newton::Settings SettingsOf(const NewtonOptions& options) {
  newton::Settings settings;
  settings.tolerances = TolerancesOf(options);
  settings.most_iterations =
      static_cast<int>(ParseCount("--max-iterations", options.most_iterations, 1, 1000000));
  if (options.solver != "ldlt" && options.solver != "cg") {
    throw UsageError(fmt::format("--solver '{}': expected ldlt or cg", options.solver));
  }
  if (options.solver == "cg") settings.solver = newton::LinearSolver::kConjugateGradients;
  return settings;
}

// What comes behind distortion/triangle/ or distortion/tetrahedron/.
std::string_view ShortName(const EnergyRow& energy) {
  const std::string_view name = energy.name;
  return name.substr(name.rfind('/') + 1);
}

std::vector<const EnergyRow*> EnergiesOf(const NewtonOptions& options) {
  std::vector<const EnergyRow*> energies;
  for (const std::string& name : options.energies) {
    const auto before = energies.size();
    std::set<std::string_view> known;
    for (const EnergyRow& energy : AllEnergies()) {
      if (!energy.name.starts_with("distortion/")) continue;
      known.insert(ShortName(energy));
      if (ShortName(energy) == name) energies.push_back(&energy);
    }
    if (energies.size() == before) {
      throw UsageError(fmt::format("--energy '{}': expected one of {}", name,
                                   known.empty() ? "none: no distortion energy was built"
                                                 : fmt::format("{}", fmt::join(known, ", "))));
    }
  }
  return energies;
}

std::vector<std::string> FiltersOf(const NewtonOptions& options,
                                   const std::vector<const EnergyRow*>& energies) {
  if (options.filters.empty()) return newton::DefaultFilters();
  std::set<std::string_view> known;
  for (const KernelRow& row : AllKernels()) {
    if (std::ranges::find(energies, row.energy) != energies.end() && row.scalar != "f32") {
      known.insert(row.filter);
    }
  }
  std::vector<std::string> filters;
  for (const std::string& filter : options.filters) {
    if (!known.contains(filter)) {
      throw UsageError(
          fmt::format("--filter '{}': expected one of\n  {}", filter, fmt::join(known, "\n  ")));
    }
    if (std::ranges::find(filters, filter) == filters.end()) filters.push_back(filter);
  }
  return filters;
}

// A contest that no filter has entered yet.
newton::Contest OfTemplate(const newton::Template& of, const EnergyRow& energy,
                           const NewtonOptions& options) {
  const std::uint64_t seed = ParseCount("--seed", options.seed, 0);
  return {of.make(of, energy, options.quick, seed), std::string(of.meaning), {}};
}

std::vector<newton::Contest> ContestsOfUser(const NewtonOptions& options,
                                            const std::vector<const EnergyRow*>& energies) {
  std::vector<newton::Contest> contests;
  try {
    const newton::Mesh disk = newton::MakeDiskOf(newton::ReadObj(*options.obj));
    for (const EnergyRow* const energy : energies) {
      if (energy->stencil != "triangle") continue;
      contests.push_back({newton::ParameterizeDisk("obj", *energy, disk),
                          fmt::format("{}, laid out", *options.obj),
                          {}});
    }
  } catch (const newton::MeshError& error) {
    throw UsageError(fmt::format("--obj '{}': {}", *options.obj, error.what()));
  }
  return contests;
}

std::vector<newton::Contest> ContestsOf(const NewtonOptions& options,
                                        const std::vector<const EnergyRow*>& energies) {
  if (options.obj) return ContestsOfUser(options, energies);
  std::vector<newton::Contest> contests;
  for (const std::string& glob : options.problems) {
    bool known = false, fits = false;
    for (const newton::Template& of : newton::AllProblems()) {
      if (glob != "all" && fnmatch(glob.c_str(), std::string(of.name).c_str(), 0) != 0) continue;
      known = true;
      for (const EnergyRow* const energy : energies) {
        if (!of.Fits(*energy)) continue;
        fits = true;
        contests.push_back(OfTemplate(of, *energy, options));
      }
    }
    if (!known) {
      throw UsageError(
          fmt::format("PROBLEM '{}': expected all or one of\n{}", glob, newton::ProblemTable()));
    }
    if (!fits) {
      throw UsageError(fmt::format(
          "PROBLEM '{}': expected an energy that is defined for its elements and its start, found "
          "--energy {}",
          glob, fmt::join(options.energies, " ")));
    }
  }
  return contests;
}

int RunNewton(const NewtonOptions& options) {
  if (options.list) {
    fmt::print("{}", newton::ProblemTable());
    return kOk;
  }
  const newton::Settings settings = SettingsOf(options);
  const std::vector<const EnergyRow*> energies = EnergiesOf(options);
  const std::vector<std::string> filters = FiltersOf(options, energies);
  std::vector<newton::Contest> contests = ContestsOf(options, energies);
  std::optional<OutputFile> file;
  if (options.json) file.emplace("--json", *options.json);
  Progress progress(isatty(STDERR_FILENO) != 0);
  std::size_t done = 0;
  for (newton::Contest& contest : contests) {
    progress.Start(contest.problem.name, filters.size());
    newton::RunContest(
        filters, settings, [&progress] { progress.Advance(1); }, contest);
    progress.Finish();
    if (Interrupted()) break;
    ++done;
    if (options.json != "-") fmt::print("{}", newton::ToTable(contest, settings));
    std::fflush(stdout);
  }
  const std::size_t all = contests.size();
  contests.resize(done);
  const auto profiles = newton::ProfilesOf(contests, filters, settings.tolerances);
  if (options.json != "-" && done > 1) fmt::print("{}", newton::ProfileTable(profiles, done));
  if (file) {
    nlohmann::ordered_json json =
        ResultHead(CommandWords(), ParseCount("--seed", options.seed, 0), done < all);
    json["newton"] = newton::ToJson(contests, all, settings, profiles);
    file->Commit(Dump(json, Detail::kSummaries));
  }
  if (done == all) return kOk;
  std::fputs("definite: interrupted; the result is partial: the problems that were complete\n",
             stderr);
  return kInterrupted;
}

}  // namespace

void AddNewton(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<NewtonOptions>();
  CLI::App* command =
      app.add_subcommand("newton", "Solves problems on meshes by Newton's method with each filter");
  CLI::Option* problems =
      command
          ->add_option("problems", options->problems,
                       "Names or globs of --list, or all (default: all that fit the energy)")
          ->type_name("PROBLEM");
  command
      ->add_option("--energy", options->energies,
                   "Distortion energies, as in definite list (default: symmetric_dirichlet)")
      ->type_name("NAME");
  command
      ->add_option("--filter", options->filters,
                   "Filters, as in definite list (default: those below)")
      ->type_name("NAME");
  command
      ->add_option("--tolerance", options->tolerances,
                   "Of the gradient, one or two; runs end at the least (default: 1e-4 1e-8)")
      ->type_name("T");
  command
      ->add_option("--max-iterations", options->most_iterations,
                   "Of a run, or of a step of time (default: 1000)")
      ->type_name("N");
  command
      ->add_option("--solver", options->solver,
                   "Of linear systems: ldlt or cg, conjugate gradients (default: ldlt)")
      ->type_name("NAME");
  command
      ->add_option("--obj", options->obj,
                   "Lay out the surface of a Wavefront OBJ; what is no disk is cut")
      ->type_name("FILE")
      ->excludes(problems);
  AddSeedOption(*command, options->seed);
  command->add_flag("--quick", options->quick, "Coarse meshes");
  AddJsonOption(*command, options->json);
  command->add_flag("--list", options->list, "Show the problems and stop");
  command->footer(fmt::format(
      "Filters by default, where an energy has them:\n  {}\n\n"
      "Tolerances are of the largest entry of the gradient, over the greatest force on a vertex\n"
      "whose elements all pull with a stress of their stiffness. A filter that does not converge\n"
      "is a finding, and exits 0.\n\n"
      "Examples:\n"
      "  definite newton --quick\n"
      "  definite newton 'disk_*' --energy symmetric_dirichlet arap --json disks.json\n"
      "  definite newton bar_twist --energy stable_neo_hookean --filter analytic numeric\n"
      "  definite newton --obj surface.obj --tolerance 1e-6",
      fmt::join(newton::DefaultFilters(), " ")));
  command->callback([options, &exit_code] { exit_code = RunNewton(*options); });
}

}  // namespace definite
