// definite export: a result as another tool reads it.

#include "benchmarks/compare/export.hpp"

#include <fmt/format.h>

#include <memory>

#include "benchmarks/compare/compare.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct ExportOptions {
  std::string file, to = "github-action-benchmark", out = "-";
};

int RunExportCommand(const ExportOptions& options) {
  if (options.to != "github-action-benchmark") {
    throw UsageError(fmt::format("--to '{}': expected github-action-benchmark", options.to));
  }
  const nlohmann::ordered_json result = ReadResult("FILE", options.file);
  OutputFile out("--out", options.out);
  try {
    out.Commit(ToCustomSmallerIsBetter(result).dump(1) + "\n");
  } catch (const CompareError& error) {
    throw UsageError(fmt::format("FILE '{}': {}", options.file, error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("FILE '{}': not as results/schema.json has it: {}", options.file,
                                 error.what()));
  }
  return kOk;
}

}  // namespace

void AddExport(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Writes the times of a result as another tool reads them");
  command->add_option("FILE", options->file, "A result of sweep or speed")->required();
  command
      ->add_option("--to", options->to,
                   "github-action-benchmark: its customSmallerIsBetter (default)")
      ->type_name("FORMAT");
  command->add_option("--out", options->out, "Where to (default: standard output)")
      ->type_name("FILE");
  command->footer(
      "Google Benchmark's own tools read what kernels_benchmark --benchmark_out=FILE writes.\n\n"
      "Examples:\n"
      "  definite sweep --quick --json new.json\n"
      "  definite export new.json --out output.json");
  command->callback([options, &exit_code] { exit_code = RunExportCommand(*options); });
}

}  // namespace definite
