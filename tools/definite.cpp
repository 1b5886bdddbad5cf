#include <fmt/core.h>

#include <exception>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/progress.hpp"
#include "tools/command_line.hpp"

namespace definite {

namespace {

std::vector<std::string> command_words;

int Main(int argc, char** argv) {
  command_words.assign(argv, argv + argc);
  CatchInterrupts();
  CLI::App app("definite measures the filters that make energy Hessians positive semidefinite.",
               "definite");
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.set_version_flag("--version", [] { return DescribeBuild().dump(2); });
  app.footer(
      "Examples:\n"
      "  definite list --long\n"
      "  definite sweep --quick\n"
      "  definite sweep --kernels 'collision/*/analytic/*' --count 1e6 --json result.json\n"
      "\nExit codes: 0 all is well, 1 a promise is broken, 2 bad input, 130 interrupted.");
  int exit_code = kOk;
  AddSweep(app, exit_code);
  AddReplay(app, exit_code);
  AddList(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {  // --help, --version
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "definite: {}\nTry 'definite --help'.\n", error.what());
    return kUsage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "definite: {}\n", error.what());
    return kUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "definite: {}\n", error.what());
    return kUsage;
  }
  return exit_code;
}

}  // namespace

const std::vector<std::string>& CommandWords() { return command_words; }

}  // namespace definite

int main(int argc, char** argv) { return definite::Main(argc, argv); }
