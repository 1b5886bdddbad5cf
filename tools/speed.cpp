// definite speed: rows against each other and against the machine.

#include "benchmarks/speed/speed.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <memory>

#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct SpeedOptions {
  std::vector<std::string> kernels = {"collision/*/signed/quadratic/*"};
  std::string distribution = "active", seed = "42";
  std::vector<std::string> rings = {"L1", "L2", "memory"};
  std::vector<std::string> threads = {"1", "2"};
  std::string rounds = "15", job = "1e7", elements = "1e5";
  std::optional<std::string> json, markdown, from;
};

nlohmann::ordered_json ReadSpeed(const std::string& path) {
  const nlohmann::ordered_json json = ReadResult("--from", path);
  if (!json.contains("speed")) {
    throw UsageError(fmt::format("--from '{}': expected a result of 'definite speed'", path));
  }
  return json;
}

std::string MarkdownOf(const nlohmann::ordered_json& json, const SpeedOptions& options) {
  try {
    return ToMarkdown(json);
  } catch (const std::exception& error) {
    throw UsageError(options.from ? fmt::format("--from '{}': {}", *options.from, error.what())
                                  : fmt::format("--markdown: {}", error.what()));
  }
}

Level LevelNamed(const std::string& name) {
  for (Level level : {Level::kL1, Level::kL2, Level::kMemory}) {
    if (name == LevelName(level)) return level;
  }
  throw UsageError(fmt::format("--ring '{}': expected L1, L2 or memory", name));
}

// Measures nothing.
int ShowEarlier(const SpeedOptions& options) {
  std::optional<OutputFile> file;
  if (options.markdown) file.emplace("--markdown", *options.markdown);
  const std::string markdown = MarkdownOf(ReadSpeed(*options.from), options);
  file ? file->Commit(markdown) : fmt::print("{}", markdown);
  return kOk;
}

int RunSpeedCommand(const SpeedOptions& options) {
  if (options.from) return ShowEarlier(options);
  SpeedPlan plan;
  plan.rows = RowsMatching(options.kernels, Outputs::kAll);
  plan.distribution = &DistributionNamed(options.distribution);
  plan.seed = ParseCount("--seed", options.seed, 0);
  plan.levels.clear();
  for (const std::string& ring : options.rings) plan.levels.push_back(LevelNamed(ring));
  plan.threads.clear();
  for (const std::string& threads : options.threads) {
    plan.threads.push_back(static_cast<int>(ParseCount("--threads", threads, 1, 1024)));
  }
  plan.rounds = static_cast<int>(ParseCount("--rounds", options.rounds, 1, 10000));
  plan.configurations = static_cast<std::int64_t>(ParseCount("--job", options.job, 0, INT64_MAX));
  plan.elements = static_cast<std::int64_t>(ParseCount("--elements", options.elements, 0, 1 << 28));
  std::erase_if(plan.rows, [&](const KernelRow* row) {
    return !plan.distribution->supports(row->energy->stencil);
  });
  if (plan.rows.empty()) {
    throw UsageError(fmt::format("--distribution '{}': it cannot draw any of the rows asked for",
                                 options.distribution));
  }
  std::optional<OutputFile> json, markdown;
  if (options.json) json.emplace("--json", *options.json);
  if (options.markdown) markdown.emplace("--markdown", *options.markdown);

  Progress progress(isatty(STDERR_FILENO) != 0);
  const SpeedResult result = RunSpeed(plan, progress);
  if (options.json != "-" && options.markdown != "-") fmt::print("{}", ToTable(result));
  const nlohmann::ordered_json as_json = ToJson(result, CommandWords());
  if (json) {
    json->Commit(as_json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
  if (markdown) markdown->Commit(MarkdownOf(as_json, options));
  if (result.partial) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return kOk;
}

}  // namespace

void AddSpeed(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SpeedOptions>();
  CLI::App* command = app.add_subcommand(
      "speed", "Times rows against each other, with the floor that the machine sets");
  AddKernelsOption(*command, options->kernels)
      ->description(
          "Rows with such a name, * crosses / (default: those of the signed quadratic\n"
          "energies, whatever their output; may be repeated)");
  AddDistributionOption(*command, options->distribution);
  AddSeedOption(*command, options->seed);
  const auto add_several = [command](const char* name, std::vector<std::string>& values,
                                     const char* help, const char* type) {
    command->add_option(name, values, help)
        ->type_name(type)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  add_several("--ring", options->rings,
              "Where the outputs go: L1, L2, memory (default: all three; may be repeated)",
              "LEVEL");
  add_several("--threads", options->threads, "Threads (default: 1, then 2; may be repeated)", "N");
  command
      ->add_option("--rounds", options->rounds, "Rounds, each in an order of its own (default: 15)")
      ->type_name("N");
  command
      ->add_option("--job", options->job,
                   "Also where the time goes when N configurations are drawn and filtered, for\n"
                   "rows with stages of their own (default: 1e7; 0: not)")
      ->type_name("N");
  command
      ->add_option("--elements", options->elements,
                   "Also N elements scatter-added to a block-sparse matrix\n"
                   "(default: 1e5; 0: not)")
      ->type_name("N");
  AddJsonOption(*command, options->json);
  command
      ->add_option("--markdown", options->markdown,
                   "Write tables as Markdown to FILE ('-' for standard output);\n"
                   "they need the signed quadratic rows in all rings")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from,
                   "Measure nothing: those tables of an earlier --json FILE")
      ->type_name("FILE");
  command->footer(
      "The rows of an energy are timed in turn, in random order, on the same configurations. A\n"
      "floor is the time that its additions, multiplications and fused multiply-adds, its\n"
      "divisions and roots, or its stores would take alone at the rates measured in this run.\n"
      "Thread CPU time on one thread, wall time on more.\n\n"
      "Examples:\n"
      "  definite speed --ring L1 --threads 1\n"
      "  definite speed --kernels '*/signed/quadratic/nearest/*' --kernels "
      "'*/quadratic/numeric/f64'\n"
      "  definite speed --distribution paper --json speed.json\n"
      "  definite speed --kernels 'collision/edge_edge/*/quadratic/analytic/f64x8*' --ring L1");
  command->callback([options, &exit_code] { exit_code = RunSpeedCommand(*options); });
}

}  // namespace definite
