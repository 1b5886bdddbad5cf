#include "tools/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <thread>

#include "benchmarks/harness/merge.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"
#include "fuzz/family.hpp"

namespace definite {

namespace {

// Levenshtein's distance from the nearest name that the glob matches; only * is special.
std::size_t EditDistance(std::string_view glob, std::string_view name) {
  std::vector<std::size_t> row(name.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (const char c : glob) {
    const std::size_t step = c == '*' ? 0 : 1;
    std::size_t diagonal = row[0];
    row[0] += step;
    for (std::size_t j = 0; j < name.size(); ++j) {
      const std::size_t above = row[j + 1];
      const std::size_t right = row[j] + step;
      row[j + 1] = std::min({above + step, right, diagonal + (c == name[j] ? 0 : step)});
      diagonal = above;
    }
  }
  return row.back();
}

// The names nearest to a word, or that have something near it within them; three at most.
std::string NearNames(std::string_view word) {
  std::vector<std::string> names;
  for (const KernelRow& row : AllKernels()) names.push_back(row.name);
  const std::string glob = fmt::format("*{}*", word);
  std::ranges::stable_sort(names, {}, [&](const std::string& n) {
    return std::pair(EditDistance(glob, n), EditDistance(word, n));
  });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, names.size()); ++i) {
    text += "\n  " + names[i];
  }
  return text;
}

}  // namespace

std::uint64_t ParseCount(const std::string& option, const std::string& text, std::uint64_t minimum,
                         std::uint64_t maximum) {
  const auto fail = [&](const std::string& expected) -> UsageError {
    return UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  };
  double value = 0;
  const char* const last = text.data() + text.size();
  auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc() && end != last && end + 1 == last) {
    const std::string_view suffixes = "kMG";
    const std::size_t power = suffixes.find(*end);
    if (power != suffixes.npos) {
      value *= std::pow(1000.0, static_cast<double>(power + 1));
      end = last;
    }
  }
  if (error != std::errc() || end != last || !(value == std::floor(value))) {
    throw fail("a whole number such as 1000, 1e7 or 10M");
  }
  if (value < static_cast<double>(minimum)) throw fail(fmt::format("at least {}", minimum));
  if (value > std::min(0x1p53, static_cast<double>(maximum))) {
    throw fail(fmt::format("at most {}", std::min(maximum, std::uint64_t{1} << 53)));
  }
  return static_cast<std::uint64_t>(value);
}

std::vector<ParameterValue> ParseOverrides(const std::vector<std::string>& words,
                                           const std::vector<const KernelRow*>& rows) {
  std::vector<ParameterValue> overrides;
  for (const std::string& word : words) {
    const auto fail = [&](const std::string& what) -> UsageError {
      return UsageError(fmt::format("--set '{}': {}", word, what));
    };
    const std::size_t equals = word.find('=');
    if (equals == word.npos) throw fail("expected NAME=VALUE, such as side=-1");
    const std::string_view name = std::string_view(word).substr(0, equals);
    double value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data() + equals + 1, last, value);
    if (error != std::errc() || end != last || !std::isfinite(value)) {
      throw fail("expected a number after the =");
    }
    const Parameter* known = nullptr;
    std::vector<std::string_view> names;  // of all rows
    for (const KernelRow* row : rows) {
      for (const Parameter& parameter : row->energy->parameters) {
        if (parameter.name == name) known = &parameter;
        if (std::ranges::find(names, parameter.name) == names.end()) {
          names.push_back(parameter.name);
        }
      }
    }
    if (!known) {
      throw fail(fmt::format("no energy asked for has a parameter '{}'; there are: {}", name,
                             fmt::join(names, ", ")));
    }
    if (std::ranges::find(overrides, name, &ParameterValue::name) != overrides.end()) {
      throw fail(fmt::format("{} is set already", name));
    }
    overrides.push_back({known->name, value});
  }
  return overrides;
}

std::vector<const KernelRow*> RowsMatching(const std::vector<std::string>& globs, Outputs outputs) {
  std::vector<const KernelRow*> all;
  for (const KernelRow& row : AllKernels()) all.push_back(&row);
  if (outputs == Outputs::kAll) {
    for (const KernelRow& row : AllOutputs()) all.push_back(&row);
  }
  const auto matches = [](const std::string& glob, const KernelRow* row) {
    return fnmatch(glob.c_str(), row->name.c_str(), 0) == 0;
  };
  for (const std::string& glob : globs) {
    if (std::ranges::none_of(all, [&](const KernelRow* row) { return matches(glob, row); })) {
      throw UsageError(
          fmt::format("--kernels '{}': no such row; the nearest are:{}", glob, NearNames(glob)));
    }
  }
  std::erase_if(all, [&](const KernelRow* row) {
    return std::ranges::none_of(globs, [&](const std::string& glob) { return matches(glob, row); });
  });
  return all;
}

const KernelRow& RowNamed(const std::string& name) {
  const KernelRow* row = FindKernel(name);
  if (row && row->output == "packed") return *row;
  throw UsageError(
      fmt::format("--kernel '{}': no such row; the nearest are:{}", name, NearNames(name)));
}

const Distribution& DistributionNamed(const std::string& name) {
  if (const Distribution* distribution = FindDistribution(name)) return *distribution;
  std::string known;
  for (const Distribution& d : AllDistributions()) {
    known += fmt::format("\n  {:<8} {}", d.name, d.description);
  }
  known += "\nor fuzz/ and a family of degenerate ones:";
  for (const fuzz::Family& family : fuzz::AllFamilies()) {
    known += fmt::format("\n  {:<14} {}", family.name, family.meaning);
  }
  throw UsageError(fmt::format(
      "--distribution '{}': expected one of{}\nor a .csv or .jsonl file of configurations", name,
      known));
}

CLI::Option* AddKernelsOption(CLI::App& command, std::vector<std::string>& globs) {
  return command
      .add_option("--kernels", globs,
                  "Rows with such a name, * crosses / (default: all; may be repeated)")
      ->type_name("GLOB")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void AddDistributionOption(CLI::App& command, std::string& name) {
  std::string known;
  for (const Distribution& d : AllDistributions()) {
    known += fmt::format("{}{}", known.empty() ? "" : ", ", d.name);
  }
  command
      .add_option("--distribution", name,
                  fmt::format("{},\nfuzz/FAMILY, .csv or .jsonl (default: {})", known, name))
      ->type_name("NAME");
}

void AddSetOption(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "Sets a parameter of energies that have it, as side=-1 (may be repeated)")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void AddSeedOption(CLI::App& command, std::string& seed) {
  command.add_option("--seed", seed, fmt::format("Seed of the configurations (default: {})", seed))
      ->type_name("N");
}

nlohmann::ordered_json ReadResult(const std::string& option, const std::string& path) {
  std::ifstream file(path);
  if (!file) throw UsageError(fmt::format("{} '{}': cannot read it", option, path));
  auto json = nlohmann::ordered_json::parse(file, nullptr, false);
  if (json.is_discarded() || !json.is_object() ||
      json.value("schema", nlohmann::ordered_json()) != "definite/1") {
    throw UsageError(
        fmt::format("{} '{}': expected a result of definite, schema definite/1", option, path));
  }
  return json;
}

SweepResult ReadSweep(const std::string& option, const std::string& path) {
  try {
    return FromJson(ReadResult(option, path));
  } catch (const MergeError& error) {
    throw UsageError(fmt::format("{} '{}': {}", option, path, error.what()));
  }
}

std::uint64_t RunOptions::Count() const {
  return ParseCount("--count", quick ? quick_count : count.value_or(default_count), 1);
}

std::uint64_t RunOptions::Seed() const { return ParseCount("--seed", seed, 0); }

std::uint64_t RunOptions::CountOf(const Distribution& distribution) const {
  if (distribution.recorded && !count && !quick) return distribution.recorded->Size();
  return Count();
}

int ThreadsOf(const std::optional<std::string>& threads) {
  return static_cast<int>(threads ? ParseCount("--threads", *threads, 1, 1024)
                                  : std::max(1u, std::thread::hardware_concurrency()));
}

void AddRunOptions(CLI::App& command, RunOptions& options) {
  CLI::Option* count =
      command
          .add_option(
              "--count", options.count,
              fmt::format("Configurations, such as 1000, 10M (default: {})", options.default_count))
          ->type_name("N");
  command
      .add_flag("--quick", options.quick,
                fmt::format("The same as --count {}", options.quick_count))
      ->excludes(count);
  AddSeedOption(command, options.seed);
  AddThreadsOption(command, options.threads);
}

void AddThreadsOption(CLI::App& command, std::optional<std::string>& threads) {
  command.add_option("--threads", threads, "Threads (default: all cores)")->type_name("N");
}

void AddJsonOption(CLI::App& command, std::optional<std::string>& path) {
  command.add_option("--json", path, "Write the whole result to FILE, - is standard output")
      ->type_name("FILE");
}

}  // namespace definite
