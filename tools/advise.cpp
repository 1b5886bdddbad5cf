// definite advise: which filter fits someone's own contacts.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "benchmarks/advice/advice.hpp"
#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct AdviseOptions {
  std::string file, tolerance = "0.1";
  std::optional<std::string> energy, threads, json;
  std::vector<std::string> overrides;
};

constexpr double kLeastTolerance = 1e-12;  // below that is rounding

double ToleranceOf(const AdviseOptions& options) {
  double value = 0;
  const std::string& text = options.tolerance;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= kLeastTolerance &&
      std::isfinite(value)) {
    return value;
  }
  throw UsageError(
      fmt::format("--tolerance '{}': expected a relative distance such as 0.1, at "
                  "least {:g}",
                  text, kLeastTolerance));
}

// By its length and penalty, such as signed/log_barrier; or the plainest of the stencil.
const EnergyRow& EnergyOf(const AdviseOptions& options, const Recorded& recorded) {
  const std::string prefix = fmt::format("collision/{}/", recorded.stencil);
  const auto wanted = options.energy
                          ? std::vector{*options.energy}
                          : std::vector<std::string>{"signed/quadratic", "unsigned/quadratic"};
  for (const std::string& name : wanted) {
    const auto at = std::ranges::find(AllEnergies(), prefix + name, &EnergyRow::name);
    if (at != AllEnergies().end()) return *at;
  }
  std::vector<std::string_view> names;
  for (const EnergyRow& energy : AllEnergies()) {
    if (energy.name.starts_with(prefix))
      names.push_back(std::string_view(energy.name).substr(prefix.size()));
  }
  if (names.empty()) {
    throw UsageError(fmt::format("FILE '{}': a {} has no contact energy to advise on", options.file,
                                 recorded.stencil));
  }
  throw UsageError(fmt::format("--energy '{}': expected one of those for {}: {}", wanted.front(),
                               recorded.stencil, fmt::join(names, ", ")));
}

SweepPlan PlanOf(const AdviseOptions& options) {
  if (!IsRecorded(options.file)) {
    throw UsageError(fmt::format("FILE '{}': expected a .csv or .jsonl file", options.file));
  }
  SweepPlan plan;
  plan.distribution = FindDistribution(options.file);
  const Recorded& recorded = *plan.distribution->recorded;
  plan.rows = Candidates(EnergyOf(options, recorded));
  plan.overrides = ParseOverrides(options.overrides, plan.rows);
  plan.count = recorded.Size();
  plan.threads = ThreadsOf(options.threads);
  // A million lines in seconds: `numeric` and what float128 says come from fewer of them.
  plan.samples = {10'000, 5'000, 100};
  return plan;
}

int RunAdvise(const AdviseOptions& options) {
  const double tolerance = ToleranceOf(options);
  const SweepPlan plan = PlanOf(options);
  std::optional<OutputFile> json;
  if (options.json) json.emplace("--json", *options.json);
  Progress progress(isatty(STDERR_FILENO) != 0);
  const SweepResult result = RunForAdvice(plan, progress);
  if (result.partial || Interrupted()) {
    std::fputs("definite: interrupted; advice needs all of the file\n", stderr);
    return kInterrupted;
  }
  const Advice advice = AdviseOn(result, tolerance);
  if (options.json != "-") fmt::print("{}", ToTable(advice, result));
  std::fputs(BrokenPromises(result).c_str(), stderr);
  if (json) {
    nlohmann::ordered_json all = ToJson(result, CommandWords(), Detail::kSummaries);
    all["advice"] = ToJson(advice, result);
    json->Commit(Dump(all, Detail::kSummaries));
  }
  return advice.chosen ? kOk : kBroken;
}

}  // namespace

void AddAdvise(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<AdviseOptions>();
  CLI::App* command = app.add_subcommand("advise", "Says which filter fits your own contacts");
  command
      ->add_option("FILE", options->file,
                   "Configurations on record: .csv or .jsonl, as docs/advice.md has it")
      ->required();
  command
      ->add_option("--energy", options->energy,
                   "Length and penalty, as signed/log_barrier (default: signed/quadratic, or\n"
                   "unsigned/quadratic where there is no sign)")
      ->type_name("NAME");
  command
      ->add_option("--tolerance", options->tolerance,
                   fmt::format("How far from the nearest PSD matrix 99 of 100 active "
                               "configurations\nmay be, relative to it (default: {})",
                               options->tolerance))
      ->type_name("T");
  AddThreadsOption(*command, options->threads);
  AddSetOption(*command, options->overrides);
  AddJsonOption(*command, options->json);
  command->footer(
      "The cheapest filter that is PSD in every configuration and within the tolerance is the one\n"
      "to take; exit code 1 if there is none. Filters are timed and checked as definite sweep "
      "does\n"
      "it, numeric on 10,000 of the lines. The file is a distribution as well.\n\n"
      "Examples:\n"
      "  definite advise contacts.csv\n"
      "  definite advise contacts.csv --energy signed/log_barrier --set eps=1e-3 --tolerance 0.01\n"
      "  definite advise contacts.jsonl --json - | jq -r .advice.chosen\n"
      "  definite sweep --distribution contacts.csv --kernels 'collision/*/analytic/*'");
  command->callback([options, &exit_code] { exit_code = RunAdvise(*options); });
}

}  // namespace definite
