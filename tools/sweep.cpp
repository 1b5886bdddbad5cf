// definite sweep: speed beside accuracy, over many drawn configurations.

#include "benchmarks/harness/sweep.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include "benchmarks/harness/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct Options {
  std::vector<std::string> kernels = {"*"};
  std::string distribution = "active";
  RunOptions run;
  std::optional<std::string> json;
  bool no_timing = false;
};

SweepPlan PlanOf(const Options& options) {
  SweepPlan plan;
  plan.rows = RowsMatching(options.kernels);
  plan.distribution = &DistributionNamed(options.distribution);
  plan.count = options.run.Count();
  plan.seed = options.run.Seed();
  plan.threads = options.run.Threads();
  plan.timing = !options.no_timing;
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

int RunSweepCommand(const Options& options) {
  const SweepPlan plan = PlanOf(options);
  std::optional<OutputFile> json;
  if (options.json) json.emplace("--json", *options.json);

  Progress progress(isatty(STDERR_FILENO) != 0);
  const SweepResult result = RunSweep(plan, progress);

  if (options.json != "-") fmt::print("{}", ToTable(result));
  const std::string broken = BrokenPromises(result);
  std::fputs(broken.c_str(), stderr);
  if (json) {
    // A path among the command's words need not be UTF-8.
    json->Commit(ToJson(result, CommandWords())
                     .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                 "\n");
  }
  if (result.partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return broken.empty() ? kOk : kBroken;
}

}  // namespace

void AddSweep(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Times rows over drawn configurations, and checks what they give");
  AddKernelsOption(*command, options->kernels);
  AddDistributionOption(*command, options->distribution);
  AddRunOptions(*command, options->run);
  AddSetOption(*command, options->run.overrides);
  AddJsonOption(*command, options->json);
  command->add_flag("--no-timing", options->no_timing, "Check only");
  command->footer(
      "Times are thread CPU time on one thread, wall time on more; 'numeric / this' is the median\n"
      "of the ratios round by round. 'rounding' is the error against the filter's definition in\n"
      "float128 in units of n u |F|, times the sine of the edge angle. A promise that is broken\n"
      "exits 1 with the command that replays it.\n\n"
      "Examples:\n"
      "  definite sweep --quick\n"
      "  definite sweep --kernels '*/analytic/*' --kernels '*/numeric/f64' --distribution paper\n"
      "  definite sweep --kernels '*/unsigned/*' --set side=-1\n"
      "  definite sweep --count 1e6 --threads 1 --json - | jq '.rows[].kernel'");
  command->callback([options, &exit_code] { exit_code = RunSweepCommand(*options); });
}

}  // namespace definite
