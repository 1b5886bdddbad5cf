// definite sweep: speed beside accuracy, over many drawn configurations.

#include "benchmarks/harness/sweep.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "benchmarks/harness/merge.hpp"
#include "benchmarks/harness/ranks.hpp"
#include "benchmarks/harness/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct SweepOptions {
  std::vector<std::string> kernels = {"*"};
  std::string distribution = "active";
  RunOptions run;
  std::optional<std::string> json, shard;
  bool no_timing = false, no_checks = false, resume = false;
};

SweepPlan PlanOf(const SweepOptions& options) {
  SweepPlan plan;
  plan.rows = RowsMatching(options.kernels);
  plan.distribution = &DistributionNamed(options.distribution);
  plan.count = options.run.CountOf(*plan.distribution);
  plan.seed = options.run.Seed();
  plan.threads = options.run.Threads();
  plan.timing = !options.no_timing;
  plan.checks = !options.no_checks;
  if (options.shard) {
    try {
      plan.shard = ParseShard(*options.shard);
    } catch (const ShardError& error) {
      throw UsageError(fmt::format("--shard {}", error.what()));
    }
  }
  std::erase_if(plan.rows, [&](const KernelRow* row) {
    return !plan.distribution->supports(row->energy->stencil);
  });
  if (plan.rows.empty()) {
    throw UsageError(fmt::format("--distribution '{}': it cannot draw any of the rows asked for",
                                 options.distribution));
  }
  plan.overrides = ParseOverrides(options.run.overrides, plan.rows);
  return plan;
}

// What --resume finds, if anything.
std::optional<SweepResult> Earlier(const SweepOptions& options, const SweepPlan& plan) {
  if (!options.resume) return std::nullopt;
  if (!options.json || options.json == "-") {
    throw UsageError("--resume: expected --json FILE, which keeps what is complete");
  }
  if (options.no_checks) throw UsageError("--resume: with --no-checks there is nothing to keep");
  if (!std::filesystem::exists(*options.json)) return std::nullopt;
  try {
    return Merge(std::vector{ReadSweep("--resume", *options.json), Prepare(plan)});
  } catch (const MergeError& error) {
    throw UsageError(fmt::format("--resume '{}': {}", *options.json, error.what()));
  }
}

// Of a run under MPI: the ranks share the configurations, and rank 0 has the result.
std::optional<SweepResult> RunOnRanks(const SweepPlan& plan, const Ranks& ranks,
                                      Progress& progress) {
  const std::string mine = CanonicalText(RunSweep(plan, progress));
  std::vector<SweepResult> parts;
  for (const std::string& part : ranks.Gather(mine)) {
    parts.push_back(FromJson(nlohmann::ordered_json::parse(part)));
  }
  if (!ranks.First()) return std::nullopt;
  return Merge(parts);
}

// How the plan is shared out, where something says so.
void ShareOut(const SweepOptions& options, const Ranks& ranks, SweepPlan& plan) {
  if (!ranks.Shared()) return;
  if (options.shard || options.resume || options.no_checks) {
    throw UsageError(
        "under MPI the ranks share the checks out: expected no --shard, --resume or --no-checks");
  }
  plan.shard = ranks.Mine();
  plan.timing = false;  // ranks of one machine are in each other's way
}

// The table comes before the file: it is not lost with it where the disk is full.
int Report(const SweepResult& result, const std::string& text, const SweepOptions& options,
           std::optional<OutputFile>& json) {
  if (options.json != "-") fmt::print("{}", ToTable(result));
  const std::string broken = BrokenPromises(result);
  std::fputs(broken.c_str(), stderr);
  if (json) json->Commit(text);
  if (result.partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return broken.empty() ? kOk : kBroken;
}

int RunSweepCommand(const SweepOptions& options) {
  SweepPlan plan = PlanOf(options);
  const Ranks ranks;
  ShareOut(options, ranks, plan);
  const std::optional<SweepResult> earlier = Earlier(options, plan);
  std::optional<OutputFile> json;
  if (options.json && ranks.First()) json.emplace("--json", *options.json);
  Progress progress(ranks.First() && isatty(STDERR_FILENO) != 0);
  if (ranks.Shared()) {
    const std::optional<SweepResult> result = RunOnRanks(plan, ranks, progress);
    if (!result) return kOk;
    return Report(*result, CanonicalText(*result), options, json);
  }
  RunControl control;
  if (earlier) control.earlier = &*earlier;
  if (options.resume) {
    control.checkpoint = [&](const SweepResult& result) { json->Commit(CanonicalText(result)); };
  }
  const SweepResult result = RunSweep(plan, progress, control);
  const std::string text = Dump(ToJson(result, CommandWords()), Detail::kWithHistograms);
  return Report(result, text, options, json);
}

}  // namespace

void AddSweep(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Times rows over drawn configurations, and checks what they give");
  AddKernelsOption(*command, options->kernels);
  AddDistributionOption(*command, options->distribution);
  AddRunOptions(*command, options->run);
  AddSetOption(*command, options->run.overrides);
  AddJsonOption(*command, options->json);
  CLI::Option* no_timing = command->add_flag("--no-timing", options->no_timing, "Check only");
  command->add_flag("--no-checks", options->no_checks, "Time only")->excludes(no_timing);
  command
      ->add_option("--shard", options->shard,
                   "Only part I of N, such as 2/7; auto: as the environment says, a Slurm array,\n"
                   "an MPI launcher, GoogleTest's or Bazel's sharding")
      ->type_name("I/N");
  command->add_flag("--resume", options->resume,
                    "Keep what is checked in the --json FILE, every 20 s, and begin from there;\n"
                    "times are measured anew");
  command->footer(
      "Times are thread CPU time on one thread, wall time on more; 'numeric / this' is the median\n"
      "of the ratios round by round. 'rounding' is the error against the filter's definition in\n"
      "float128 in units of n u |F|, times the sine of the edge angle. A promise that is broken\n"
      "exits 1 with the command that replays it.\n\n"
      "Examples:\n"
      "  definite sweep --quick\n"
      "  definite sweep --kernels '*/analytic/*' --kernels '*/numeric/f64' --distribution paper\n"
      "  definite sweep --kernels '*/unsigned/*' --set side=-1\n"
      "  definite sweep --count 1e6 --threads 1 --json - | jq '.rows[].kernel'\n"
      "  definite sweep --distribution contacts.csv   # all of a file: docs/advice.md\n"
      "  definite sweep --count 1e8 --no-timing --shard 2/7 --resume --json part-2.json\n"
      "  definite merge part-*.json --json whole.json");
  command->callback([options, &exit_code] { exit_code = RunSweepCommand(*options); });
}

}  // namespace definite
