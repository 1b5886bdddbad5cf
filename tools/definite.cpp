#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/progress.hpp"
#include "tools/command_line.hpp"

namespace definite {

namespace {

std::vector<std::string> command_words;

// Each option with the name of its value and nothing else.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(24); }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() ? " " + option->get_type_name() : "";
  }
};

int Fail(const std::string& message) {
  std::fputs(fmt::format("definite: {}\n", message).c_str(), stderr);
  return kUsage;
}

// What is wrong with the words of the command line. A word that is not understood comes first: it
// often explains what is missing.
std::string Explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> unknown = app.remaining(true);
  std::string what = error.what();
  if (chosen.empty()) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    what = fmt::format("{}expected a subcommand: {}",
                       unknown.empty() ? "" : fmt::format("'{}': ", unknown.front()),
                       fmt::join(names, ", "));
  } else if (!unknown.empty()) {
    what = fmt::format("'{}': {} has no such option or argument", unknown.front(),
                       chosen.front()->get_name());
  }
  return fmt::format("{}\nTry 'definite {}--help'.", what,
                     chosen.empty() ? "" : chosen.front()->get_name() + " ");
}

int Run(int argc, char** argv) {
  CLI::App app("definite measures the filters that make energy Hessians positive semidefinite.",
               "definite");
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help");
  app.set_version_flag(
      "--version", [] { return DescribeBuild().dump(2); }, "Print the commit and how it was built");
  app.footer(
      "Examples:\n"
      "  definite list --long\n"
      "  definite sweep --quick\n"
      "  definite sweep --kernels 'collision/*/analytic/*' --count 1e6 --json result.json\n"
      "  definite verify --quick\n"
      "\nExit codes: 0 all is well, 1 a promise is broken or something worse, 2 bad input, 130 "
      "interrupted.");
  int exit_code = kOk;
  AddSweep(app, exit_code);
  AddSpeed(app, exit_code);
  AddReplay(app, exit_code);
  AddList(app, exit_code);
  AddReproduce(app, exit_code);
  AddVerify(app, exit_code);
  AddMerge(app, exit_code);
  AddCompare(app, exit_code);
  AddDoctor(app, exit_code);
  AddExport(app, exit_code);
  AddReport(app, exit_code);
  AddAdvise(app, exit_code);
  AddFuzz(app, exit_code);
  AddScene(app, exit_code);
  AddNewton(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {  // --help, --version
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    return Fail(Explain(app, error));
  } catch (const std::exception& error) {
    return Fail(error.what());
  }
  return exit_code;
}

int Main(int argc, char** argv) {
  command_words.assign(argv, argv + argc);
  CatchInterrupts();
  const int exit_code = Run(argc, argv);
  if (std::fflush(stdout) != 0) {
    return Fail(fmt::format("standard output: cannot write it: {}", std::strerror(errno)));
  }
  return exit_code;
}

}  // namespace

const std::vector<std::string>& CommandWords() { return command_words; }

}  // namespace definite

int main(int argc, char** argv) { return definite::Main(argc, argv); }
