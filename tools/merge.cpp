// definite merge: the parts of a sweep as one.

#include "benchmarks/harness/merge.hpp"

#include <fmt/format.h>

#include <memory>

#include "benchmarks/harness/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct MergeOptions {
  std::vector<std::string> files;
  std::optional<std::string> json;
};

int RunMergeCommand(const MergeOptions& options) {
  std::optional<OutputFile> json;
  if (options.json) json.emplace("--json", *options.json);
  std::vector<SweepResult> parts;
  for (const std::string& file : options.files) parts.push_back(ReadSweep("FILE", file));
  SweepResult whole;
  try {
    whole = Merge(parts);
  } catch (const MergeError& error) {
    throw UsageError(fmt::format("merge: {}", error.what()));
  }
  if (options.json != "-") fmt::print("{}", ToTable(whole));
  if (json) json->Commit(CanonicalText(whole));
  const std::string broken = BrokenPromises(whole);
  std::fputs(broken.c_str(), stderr);
  if (whole.partial) {
    std::fputs(fmt::format("definite: parts are missing: {}\n", DescribeMissing(whole)).c_str(),
               stderr);
  }
  return broken.empty() ? kOk : kBroken;
}

}  // namespace

void AddMerge(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Puts the parts of a sweep together");
  command->add_option("FILE", options->files, "Results of 'definite sweep' or of merge")
      ->type_name("FILE...")
      ->required();
  AddJsonOption(*command, options->json);
  command->footer(
      "The parts are shards, in any order, interrupted runs, or mergers of these; what several\n"
      "have in common must agree and counts once. The result has no timing, for that belongs to\n"
      "one machine, and is the same file byte for byte however the sweep was shared out. Parts of\n"
      "another plan or program are refused.\n\n"
      "Examples:\n"
      "  definite merge part-1.json part-2.json part-3.json --json whole.json\n"
      "  definite merge single.json --json canonical.json");
  command->callback([options, &exit_code] { exit_code = RunMergeCommand(*options); });
}

}  // namespace definite
