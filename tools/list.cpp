// definite list: the rows there are.

#include <fmt/core.h>

#include <memory>

#include "benchmarks/harness/promises.hpp"
#include "tools/command_line.hpp"

namespace definite {

void AddList(CLI::App& app, int&) {
  struct Options {
    std::vector<std::string> kernels = {"*"};
    bool long_form = false, promises = false, outputs = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("list", "Prints the full name of each row, one a line");
  CLI::Option* kernels = AddKernelsOption(*command, options->kernels);
  CLI::Option* long_form =
      command->add_flag("--long", options->long_form, "Sources and parameters too");
  command->add_flag("--outputs", options->outputs,
                    "Rows whose output is not a packed matrix too: definite speed times them");
  command
      ->add_flag("--promises", options->promises,
                 "Instead what filters promise, and their exemptions")
      ->excludes(kernels)
      ->excludes(long_form);
  command->footer("Examples:\n  definite list\n  definite list --long --kernels '*/analytic/*'");
  command->callback([options] {
    if (options->promises) {
      fmt::print("{}", PromiseTable());
      return;
    }
    for (const KernelRow* row :
         RowsMatching(options->kernels, options->outputs ? Outputs::kAll : Outputs::kPacked)) {
      fmt::print("{}\n", row->name);
      if (!options->long_form) continue;
      fmt::print("  energy  {}\n  filter  {}\n", row->energy->source, row->source);
      for (const Parameter& p : row->energy->parameters) {
        fmt::print("  {:<7} {} (default {})\n", p.name, p.meaning, p.value);
      }
    }
  });
}

}  // namespace definite
