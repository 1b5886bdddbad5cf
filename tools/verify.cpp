// definite verify: whether the mathematics holds, of kernels and of the paper.

#include "benchmarks/verify/verify.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "benchmarks/plans/shi_kim_2023_errata.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct VerifyOptions {
  std::vector<std::string> kernels = {"*"};
  std::optional<std::string> distribution, index, json, markdown;
  RunOptions run;
  bool errata = false;
};

verify::Plan PlanOf(const VerifyOptions& options) {
  verify::Plan plan;
  for (const KernelRow* row : RowsMatching(options.kernels)) {
    if (plan.subjects.empty() || plan.subjects.back().energy != row->energy) {
      plan.subjects.push_back({row->energy, {}, nullptr});
    }
    plan.subjects.back().rows.push_back(row);
  }
  for (verify::Subject& s : plan.subjects) s = verify::SubjectOf(*s.energy, s.rows);
  for (const Distribution& distribution : AllDistributions()) {
    plan.distributions.push_back(&distribution);
  }
  if (options.distribution) plan.distributions = {&DistributionNamed(*options.distribution)};
  plan.count = options.run.Count();
  if (options.index) {
    plan.first = ParseCount("--index", *options.index, 0);
    plan.count = 1;
  }
  plan.seed = options.run.Seed();
  plan.threads = options.run.Threads();
  return plan;
}

int PrintErrata(const VerifyOptions& options) {
  std::optional<OutputFile> file;
  if (options.markdown) file.emplace("--markdown", *options.markdown);
  const std::string markdown = ShiKim2023Errata::Markdown();
  if (options.markdown != "-") fmt::print("{}", markdown);
  if (file) file->Commit(markdown);
  return kOk;
}

int RunVerify(const VerifyOptions& options) {
  if (options.errata) return PrintErrata(options);
  const verify::Plan plan = PlanOf(options);
  std::optional<OutputFile> json;
  if (options.json) json.emplace("--json", *options.json);

  Progress progress(isatty(STDERR_FILENO) != 0);
  const verify::Result result = verify::RunChecks(plan, progress);

  if (options.json != "-") fmt::print("{}", verify::ToTable(result));
  const std::string failures = verify::Failures(result);
  std::fputs(failures.c_str(), stderr);
  if (json) {
    // A path among the command's words need not be UTF-8.
    json->Commit(verify::ToJson(result, CommandWords())
                     .dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
                 "\n");
  }
  if (result.partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return failures.empty() ? kOk : kBroken;
}

// What each check says, as a list.
std::string Checks() {
  std::string text;
  for (const verify::Check& check : verify::AllChecks()) {
    text += fmt::format("  {:<22} {}\n", check.name, check.says);
  }
  return text;
}

}  // namespace

void AddVerify(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<VerifyOptions>();
  options->run.default_count = "1000";
  options->run.quick_count = "100";
  CLI::App* command = app.add_subcommand(
      "verify", "Checks the mathematics: derivatives, eigensystems, identities, each row");
  CLI::Option* kernels = AddKernelsOption(*command, options->kernels);
  CLI::Option* distribution = command
                                  ->add_option("--distribution", options->distribution,
                                               "Only configurations of this one (default: of each)")
                                  ->type_name("NAME");
  AddRunOptions(*command, options->run);
  CLI::Option* index =
      command->add_option("--index", options->index, "Only this configuration of the distribution")
          ->type_name("N");
  AddJsonOption(*command, options->json);
  CLI::Option* errata = command->add_flag("--errata", options->errata,
                                          "Instead the misprints of Shi & Kim 2023, measured");
  command
      ->add_option("--markdown", options->markdown, "With --errata: write docs/errata.md to FILE")
      ->type_name("FILE")
      ->needs(errata);
  index->excludes("--count")->excludes("--quick");
  for (CLI::Option* other : {kernels, distribution, index}) errata->excludes(other);
  for (const char* other : {"--count", "--quick", "--seed", "--threads", "--json"}) {
    errata->excludes(command->get_option(other));
  }
  command->footer(
      "--count is that of each distribution. Every check is made in float128 where it needs to "
      "be;\n"
      "its worst figure is given in units of its bound, with the configuration it was found at. "
      "One\n"
      "that fails exits 1 with the command that replays it.\n\nChecks:\n" +
      Checks() +
      "\nExamples:\n"
      "  definite verify --quick\n"
      "  definite verify --kernels 'collision/*/signed/*' --count 1e4 --json verified.json\n"
      "  definite verify --errata");
  command->callback([options, &exit_code] { exit_code = RunVerify(*options); });
}

}  // namespace definite
