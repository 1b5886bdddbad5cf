// definite reproduce: a named plan of sweeps, with its tables and claims.

#include <fmt/core.h>
#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/plans/plan.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct ReproduceOptions {
  RunOptions run;
  std::vector<std::string> kernels;
  std::optional<std::string> json, markdown, from;
};

nlohmann::ordered_json Read(const Plan& plan, const std::string& path) {
  nlohmann::ordered_json json = ReadResult("--from", path);
  if (json.value("paper", nlohmann::ordered_json()) != plan.name) {
    throw UsageError(
        fmt::format("--from '{}': expected a result of 'definite reproduce {}'", path, plan.name));
  }
  return json;
}

// The plan's sweeps, of those rows that were asked for and can be drawn.
std::vector<SweepPlan> SweepsOf(const Plan& plan, const ReproduceOptions& options) {
  if (!options.kernels.empty() && !plan.divisible) {
    throw UsageError(fmt::format("--kernels '{}': the tables of {} need all their rows",
                                 options.kernels.front(), plan.name));
  }
  const std::vector<const KernelRow*> asked =
      RowsMatching(options.kernels.empty() ? std::vector<std::string>{"*"} : options.kernels);
  std::vector<SweepPlan> sweeps;
  std::vector<const KernelRow*> all;
  for (const PlannedSweep& planned : plan.sweeps()) {
    SweepPlan& sweep = sweeps.emplace_back();
    sweep.distribution = &DistributionNamed(std::string(planned.distribution));
    for (const KernelRow* row : RowsMatching(planned.rows)) {
      if (sweep.distribution->supports(row->energy->stencil) &&
          std::ranges::find(asked, row) != asked.end()) {
        sweep.rows.push_back(row);
      }
    }
    sweep.overrides = planned.overrides;
    sweep.samples = plan.samples;
    sweep.count = options.run.Count();
    sweep.seed = options.run.Seed();
    sweep.threads = options.run.Threads();
    sweep.timing = plan.timing;
    all.insert(all.end(), sweep.rows.begin(), sweep.rows.end());
  }
  if (all.empty()) {
    throw UsageError(fmt::format("--kernels '{}': {} has none of these rows",
                                 options.kernels.front(), plan.name));
  }
  for (const ParameterValue& value : ParseOverrides(options.run.overrides, all)) {
    for (SweepPlan& sweep : sweeps) {
      // What the plan itself sets holds.
      if (std::ranges::find(sweep.overrides, value.name, &ParameterValue::name) ==
          sweep.overrides.end()) {
        sweep.overrides.push_back(value);
      }
    }
  }
  std::erase_if(sweeps, [](const SweepPlan& sweep) { return sweep.rows.empty(); });
  return sweeps;
}

int RunReproduce(const Plan& plan, const ReproduceOptions& options) {
  std::optional<OutputFile> json_file, markdown_file;
  std::vector<SweepPlan> sweeps;
  if (!options.from) sweeps = SweepsOf(plan, options);
  if (options.json) json_file.emplace("--json", *options.json);
  if (options.markdown) markdown_file.emplace("--markdown", *options.markdown);

  nlohmann::ordered_json json;
  std::string broken;
  bool partial = false;
  if (options.from) {
    json = Read(plan, *options.from);
  } else {
    Progress progress(isatty(STDERR_FILENO) != 0);
    const std::vector<SweepResult> results = RunSweeps(sweeps, progress);
    json = ToJson(results, CommandWords(), plan.detail);
    json["paper"] = plan.name;
    for (const SweepResult& result : results) broken += BrokenPromises(result);
    partial = json.at("partial");
  }
  std::string markdown;
  try {
    if (plan.claims) json["claims"] = plan.claims(json);
    markdown = plan.markdown(json);
  } catch (const std::exception& error) {
    if (!options.from) throw;
    throw UsageError(fmt::format("--from '{}': {}", *options.from, error.what()));
  }
  if (options.json != "-") fmt::print("{}", markdown);
  std::fputs(broken.c_str(), stderr);
  if (json_file) json_file->Commit(Dump(json, plan.detail));
  if (markdown_file) markdown_file->Commit(markdown);
  if (partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return broken.empty() ? kOk : kBroken;
}

const Plan& PlanNamed(const std::string& name) {
  const auto at = std::ranges::find(AllPlans(), name, &Plan::name);
  if (at != AllPlans().end()) return *at;
  std::string known;
  for (const Plan& plan : AllPlans())
    known += fmt::format("\n  {:<18} {}", plan.name, plan.purpose);
  throw UsageError(fmt::format("plan '{}': expected one of{}", name, known));
}

}  // namespace

void AddReproduce(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ReproduceOptions>();
  const auto name = std::make_shared<std::string>();
  options->run.default_count = "the plan's";
  CLI::App* command = app.add_subcommand(
      "reproduce", "Runs a named plan of sweeps: its tables, with a verdict on its claims");
  std::string plans = "Which one (required):";
  for (const Plan& plan : AllPlans()) {
    plans += fmt::format("\n{} ({}): {}", plan.name, plan.count, plan.purpose);
  }
  command->add_option("plan", *name, plans)->required()->type_name("NAME");
  AddKernelsOption(*command, options->kernels);
  AddRunOptions(*command, options->run);
  AddSetOption(*command, options->run.overrides);
  AddJsonOption(*command, options->json);
  command->add_option("--markdown", options->markdown, "Write the tables to FILE too")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from,
                   "Measure nothing: tables and claims of an earlier --json FILE")
      ->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  definite reproduce shi-kim-2023 --quick\n"
      "  definite reproduce shi-kim-2023 --count 1e7 --threads 2 --json result.json\n"
      "  definite reproduce shi-kim-2023 --from result.json\n"
      "  definite reproduce collision-accuracy --kernels 'collision/vertex_edge/*' --quick");
  command->callback([options, name, &exit_code] {
    const Plan& plan = PlanNamed(*name);
    options->run.default_count = plan.count;
    exit_code = RunReproduce(plan, *options);
  });
}

}  // namespace definite
