// definite compare: what became slower or less accurate.

#include "benchmarks/compare/compare.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <memory>

#include "benchmarks/compare/paired.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string base, now;
  std::optional<std::string> again, json, markdown;
  std::string threshold = "3";
  bool accuracy = false, across = false, paired = false;
  std::vector<std::string> kernels = {
      "collision/*/signed/quadratic/analytic/*", "collision/*/signed/quadratic/nearest/*",
      "collision/*/signed/quadratic/split/*", "collision/*/signed/quadratic/gauss_newton/*"};
  std::string count = "2e5", rounds = "15", distribution = "active", seed = "42";
};

Limits LimitsOf(const CompareOptions& options) {
  double percent = 0;
  const char* const last = options.threshold.data() + options.threshold.size();
  const auto [end, error] = std::from_chars(options.threshold.data(), last, percent);
  if (error != std::errc() || end != last || !(percent >= 0 && percent <= 1000)) {
    throw UsageError(
        fmt::format("--threshold '{}': expected percent, such as 3 or 0.5", options.threshold));
  }
  Limits limits;
  limits.threshold = percent / 100;
  return limits;
}

// Runs `what` on a file, whose name goes into the error.
template <class F>
auto Of(const std::string& path, F what) {
  try {
    return what();
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(
        fmt::format("'{}': not as results/schema.json has it: {}", path, error.what()));
  } catch (const CompareError& error) {
    throw UsageError(fmt::format("'{}': {}", path, error.what()));
  }
}

void RequireSame(const CompareOptions& options, const std::string& path, const Json& base,
                 const Json& other) {
  if (options.across) return;
  const std::string differences = Of(path, [&] { return Differences(base, other); });
  if (differences.empty()) return;
  throw UsageError(
      fmt::format("'{}' and '{}' are not of the same kind:{}\n--across compares them "
                  "all the same",
                  options.base, path, differences));
}

template <class C>
void Write(const C& comparison, const CompareOptions& options, std::optional<OutputFile>& json,
           std::optional<OutputFile>& markdown) {
  if (options.json != "-" && options.markdown != "-") fmt::print("{}", ToTable(comparison));
  if (json) json->Commit(ToJson(comparison).dump(1) + "\n");
  if (markdown) markdown->Commit(ToMarkdown(comparison));
}

int RunCompareCommand(const CompareOptions& options) {
  const Limits limits = LimitsOf(options);
  std::optional<OutputFile> json, markdown;
  if (options.json) json.emplace("--json", *options.json);
  if (options.markdown) markdown.emplace("--markdown", *options.markdown);

  if (options.paired) {
    PairedPlan plan;
    plan.base = options.base;
    plan.now = options.now;
    plan.rounds = static_cast<int>(ParseCount("--rounds", options.rounds, 5, 1000));
    plan.arguments = {"--distribution", options.distribution,
                      "--count",        std::to_string(ParseCount("--count", options.count, 1)),
                      "--seed",         std::to_string(ParseCount("--seed", options.seed, 0))};
    for (const std::string& glob : options.kernels) {
      plan.arguments.push_back("--kernels");
      plan.arguments.push_back(glob);
    }
    Progress progress(isatty(STDERR_FILENO) != 0);
    try {
      const PairedTimes times = RunPaired(plan, progress);
      if (times.partial) {
        std::fputs("definite: interrupted before all rounds were done; no verdict\n", stderr);
        return kInterrupted;
      }
      const Comparison comparison = Compare(times.base, times.now, std::nullopt, limits);
      Write(comparison, options, json, markdown);
      return comparison.Regressed() ? kBroken : kOk;
    } catch (const CompareError& error) {
      throw UsageError(fmt::format("--paired: {}", error.what()));
    }
  }

  const Json base = ReadResult("BASE", options.base), now = ReadResult("NEW", options.now);
  RequireSame(options, options.now, base, now);
  if (options.accuracy) {
    const AccuracyComparison comparison =
        Of(options.now, [&] { return CompareAccuracy(base, now); });
    Write(comparison, options, json, markdown);
    return comparison.losses.empty() ? kOk : kBroken;
  }
  std::optional<std::vector<Timed>> again;
  if (options.again) {
    const Json other = ReadResult("--aa", *options.again);
    RequireSame(options, *options.again, base, other);
    again = Of(*options.again, [&] { return TimesOf(other); });
  }
  const std::vector<Timed> old_times = Of(options.base, [&] { return TimesOf(base); }),
                           new_times = Of(options.now, [&] { return TimesOf(now); });
  const Comparison comparison =
      Of(options.now, [&] { return Compare(old_times, new_times, again, limits); });
  Write(comparison, options, json, markdown);
  return comparison.Regressed() ? kBroken : kOk;
}

}  // namespace

void AddCompare(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Says what became slower, or less accurate");
  command->add_option("BASE", options->base, "A result of sweep or speed; a program if --paired")
      ->required();
  command->add_option("NEW", options->now, "What is held against it")->required();
  CLI::Option* accuracy = command->add_flag(
      "--accuracy", options->accuracy,
      "Distances, defects, rounding, verdicts and broken promises instead of times");
  CLI::Option* again =
      command
          ->add_option("--aa", options->again,
                       "Another run of the base, whose differences from it are the noise floor")
          ->type_name("FILE");
  command
      ->add_option("--threshold", options->threshold,
                   "Least slowdown that counts, in percent (default: 3)")
      ->type_name("P");
  CLI::Option* across = command->add_flag(
      "--across", options->across, "Compare although machine, build, protocol or plan differ");
  CLI::Option* paired = command->add_flag(
      "--paired", options->paired,
      "BASE and NEW are two programs, in turn (A B B A): what decides small changes");
  paired->excludes(accuracy)->excludes(again)->excludes(across);
  accuracy->excludes(again);
  AddKernelsOption(*command, options->kernels)
      ->description(
          "With --paired: rows with such a name (default: analytic, split, nearest and\n"
          "gauss_newton of signed quadratic; may be repeated)");
  AddDistributionOption(*command, options->distribution);
  AddSeedOption(*command, options->seed);
  command->add_option("--count", options->count, "With --paired: configurations (default: 2e5)")
      ->type_name("N");
  command->add_option("--rounds", options->rounds, "With --paired: rounds (default: 15)")
      ->type_name("N");
  AddJsonOption(*command, options->json);
  command
      ->add_option("--markdown", options->markdown,
                   "Write the table as Markdown to FILE, for a comment ('-': standard output)")
      ->type_name("FILE");
  command->footer(
      "A row is slower if its ratio, round by round, differs from 1 (signed ranks, corrected for\n"
      "many comparisons) and is beyond the noise floor and the threshold. A loss of accuracy\n"
      "counts at any size beyond rounding. Exit codes: 0 nothing is worse, 1 something is, 2 the\n"
      "two cannot be compared.\n\n"
      "Examples:\n"
      "  definite sweep --quick --json base.json        # and again, as again.json\n"
      "  definite compare base.json new.json --aa again.json --markdown comment.md\n"
      "  definite compare --accuracy base.json new.json\n"
      "  definite compare --paired old/definite new/definite");
  command->callback([options, &exit_code] { exit_code = RunCompareCommand(*options); });
}

}  // namespace definite
