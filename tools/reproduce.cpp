// definite reproduce: a paper's tables and claims, measured again.

#include <fmt/core.h>
#include <unistd.h>

#include <fstream>
#include <memory>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/papers/shi_kim_2023.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct Options {
  RunOptions run;
  std::optional<std::string> json, markdown, from;
};

nlohmann::ordered_json Read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw UsageError(fmt::format("--from '{}': cannot read it", path));
  const auto json = nlohmann::ordered_json::parse(file, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("schema", "") != "definite/1" ||
      json.value("paper", "") != ShiKim2023::kName) {
    throw UsageError(fmt::format("--from '{}': expected a result of 'definite reproduce {}'", path,
                                 ShiKim2023::kName));
  }
  return json;
}

// Measures what the paper's tables need.
SweepResult Measure(const Options& options) {
  SweepPlan plan;
  plan.rows = RowsMatching(ShiKim2023::Rows());
  plan.distribution = &DistributionNamed(ShiKim2023::kDistribution);
  plan.count = options.run.Count();
  plan.seed = options.run.Seed();
  plan.threads = options.run.Threads();
  Progress progress(isatty(STDERR_FILENO) != 0);
  return RunSweep(plan, progress);
}

int RunReproduce(const Options& options) {
  std::optional<OutputFile> json_file, markdown_file;
  if (options.json) json_file.emplace("--json", *options.json);
  if (options.markdown) markdown_file.emplace("--markdown", *options.markdown);

  nlohmann::ordered_json json;
  std::string broken;
  bool partial = false;
  if (options.from) {
    json = Read(*options.from);
  } else {
    const SweepResult result = Measure(options);
    json = ToJson(result, CommandWords(), Detail::kSummaries);
    json["paper"] = ShiKim2023::kName;
    broken = BrokenPromises(result);
    partial = result.partial;
  }
  std::string markdown;
  try {
    json["claims"] = ShiKim2023::Claims(json);
    markdown = ShiKim2023::Markdown(json);
  } catch (const std::exception& error) {
    if (!options.from) throw;
    throw UsageError(fmt::format("--from '{}': {}", *options.from, error.what()));
  }
  if (options.json != "-") fmt::print("{}", markdown);
  std::fputs(broken.c_str(), stderr);
  if (json_file) {
    json_file->Commit(json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
  if (markdown_file) markdown_file->Commit(markdown);
  if (partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return broken.empty() ? kOk : kBroken;
}

}  // namespace

void AddReproduce(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<Options>();
  const auto paper = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "reproduce", "Measures a paper's tables again, with a verdict on its claims");
  command->add_option("paper", *paper, fmt::format("Which one: {}", ShiKim2023::kName))
      ->required()
      ->check(CLI::IsMember({ShiKim2023::kName}))
      ->type_name("NAME");
  AddRunOptions(*command, options->run);
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
      "  definite reproduce shi-kim-2023 --from result.json");
  command->callback([options, paper, &exit_code] { exit_code = RunReproduce(*options); });
}

}  // namespace definite
