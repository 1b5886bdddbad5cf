#pragma once

// What the subcommands share: one grammar for all.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/sweep.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// Exit codes.
inline constexpr int kOk = 0, kBroken = 1, kUsage = 2, kInterrupted = 130;

// Bad input. The message names the value, its place and what was expected.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A whole number such as 1000, 1e7, 10M, 2.5k. `option` is named in the error.
std::uint64_t ParseCount(const std::string& option, const std::string& text, std::uint64_t minimum,
                         std::uint64_t maximum = UINT64_MAX);

// The rows whose names match a glob, in which * crosses /. Throws UsageError with near names if
// there is none.
enum class Outputs { kPacked, kAll };
std::vector<const KernelRow*> RowsMatching(const std::vector<std::string>& globs,
                                           Outputs outputs = Outputs::kPacked);

const KernelRow& RowNamed(const std::string& name);  // packed
const Distribution& DistributionNamed(const std::string& name);

// Parameters set by words such as "side=-1". Throws UsageError if a word is not like this, or names
// what none of the rows' energies has.
std::vector<ParameterValue> ParseOverrides(const std::vector<std::string>& words,
                                           const std::vector<const KernelRow*>& rows);

// A result that definite wrote. Throws UsageError, naming the option, if the file is not one.
nlohmann::ordered_json ReadResult(const std::string& option, const std::string& path);

// A sweep's, with its histograms. Throws UsageError likewise.
SweepResult ReadSweep(const std::string& option, const std::string& path);

// All cores if not given. Throws UsageError.
int ThreadsOf(const std::optional<std::string>& threads);

// What a run over many configurations is told.
struct RunOptions {
  std::string default_count = "1e7", quick_count = "1e5", seed = "42";
  std::optional<std::string> count, threads;
  std::vector<std::string> overrides;
  bool quick = false;

  // Throw UsageError.
  std::uint64_t Count() const;  // quick_count if quick
  // The same, but all of a distribution that is on record unless told otherwise.
  std::uint64_t CountOf(const Distribution& distribution) const;
  std::uint64_t Seed() const;
  int Threads() const { return ThreadsOf(threads); }
};

// Options that several subcommands have.
void AddRunOptions(CLI::App& command, RunOptions& options);
void AddJsonOption(CLI::App& command, std::optional<std::string>& path);
CLI::Option* AddKernelsOption(CLI::App& command, std::vector<std::string>& globs);
void AddDistributionOption(CLI::App& command, std::string& name);
void AddThreadsOption(CLI::App& command, std::optional<std::string>& threads);
void AddSeedOption(CLI::App& command, std::string& seed);
void AddSetOption(CLI::App& command, std::vector<std::string>& overrides);

// Registers a subcommand with its options; `exit_code` gets what it returns. One for each file.
void AddSweep(CLI::App& app, int& exit_code);
void AddSpeed(CLI::App& app, int& exit_code);
void AddReplay(CLI::App& app, int& exit_code);
void AddList(CLI::App& app, int& exit_code);
void AddReproduce(CLI::App& app, int& exit_code);
void AddVerify(CLI::App& app, int& exit_code);
void AddMerge(CLI::App& app, int& exit_code);
void AddCompare(CLI::App& app, int& exit_code);
void AddDoctor(CLI::App& app, int& exit_code);
void AddExport(CLI::App& app, int& exit_code);
void AddReport(CLI::App& app, int& exit_code);
void AddAdvise(CLI::App& app, int& exit_code);
void AddFuzz(CLI::App& app, int& exit_code);
void AddScene(CLI::App& app, int& exit_code);
void AddNewton(CLI::App& app, int& exit_code);

// The words of the command line, as given.
const std::vector<std::string>& CommandWords();

}  // namespace definite
