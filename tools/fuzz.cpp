// definite fuzz: goes looking for the configurations that break a filter.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/report.hpp"
#include "fuzz/climb.hpp"
#include "fuzz/report.hpp"
#include "fuzz/zoo.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kCheckpointSeconds = 20;

struct FuzzOptions {
  std::vector<std::string> kernels = {"*"}, families;
  RunOptions run = {"1e6", "1e5", "42", {}, {}, {}, false};
  std::optional<std::string> json, shard, corpus, from, climb;
  double minutes = 0;
  bool resume = false, list = false, zoo = false;
};

std::vector<const fuzz::Family*> FamiliesOf(const FuzzOptions& options) {
  std::vector<const fuzz::Family*> families;
  for (const fuzz::Family& family : fuzz::AllFamilies()) {
    if (options.families.empty() || std::ranges::count(options.families, family.name)) {
      families.push_back(&family);
    }
  }
  for (const std::string& name : options.families) {
    if (std::ranges::find(families, name, &fuzz::Family::name) != families.end()) continue;
    throw UsageError(
        fmt::format("--families '{}': expected names of\n{}", name, fuzz::FamilyTable()));
  }
  return families;
}

fuzz::Plan PlanOf(const FuzzOptions& options) {
  fuzz::Plan plan;
  plan.rows = RowsMatching(options.kernels);
  plan.families = FamiliesOf(options);
  plan.seed = options.run.Seed();
  // What is seen of each cell in float128, which takes milliseconds.
  plan.samples = options.run.quick ? Samples{4, 4, 1} : Samples{16, 64, 2};
  plan.worst_cases = !options.run.quick;
  const std::size_t cells = CellsOf(plan).size();
  if (cells == 0) {
    throw UsageError("--families: none has a meaning for the energies of the rows asked for");
  }
  plan.each = std::max<std::uint64_t>(1, CeilDivide<std::uint64_t>(options.run.Count(), cells));
  return plan;
}

// The cells of a run, by name: those of its file, and those that come.
using Done = std::map<std::string, Json>;

// What --resume finds, with as many passes as that has.
Done Earlier(const FuzzOptions& options, fuzz::Plan& plan) {
  Done done;
  if (!options.resume) return done;
  if (!options.json || options.json == "-") {
    throw UsageError("--resume: expected --json FILE, which keeps what is complete");
  }
  if (!std::filesystem::exists(*options.json)) return done;
  const Json earlier = ReadResult("--resume", *options.json);
  const auto refuse = [&](const std::string& why) {
    throw UsageError(fmt::format("--resume '{}': {}", *options.json, why));
  };
  if (!earlier.contains("fuzz")) refuse("expected a result of definite fuzz");
  if (earlier.at("build") != DescribeBuild()) refuse("made by another program");
  if (earlier.at("protocol") != ProtocolHash()) refuse("made under another protocol");
  Json then = earlier.at("fuzz").at("plan"), now = ToJson(plan);
  plan.passes = then.at("passes");
  now["passes"] = then["passes"];
  for (const auto& [key, value] : now.items()) {
    if (then.at(key) != value)
      refuse(fmt::format("its {} are others: {}", key, then.at(key).dump()));
  }
  for (const Json& cell : earlier.at("fuzz").at("cells")) done[fuzz::NameOf(cell)] = cell;
  return done;
}

// A run with what it has so far.
class FuzzRun {
 public:
  FuzzRun(const FuzzOptions& options, std::optional<OutputFile>& file)
      : options_(options),
        file_(file),
        plan_(PlanOf(options)),
        done_(Earlier(options, plan_)),
        start_(WallSeconds()) {
    if (!options.shard) return;
    try {
      shard_ = ParseShard(*options.shard);
    } catch (const ShardError& error) {
      throw UsageError(fmt::format("--shard {}", error.what()));
    }
  }

  // Passes over all cells, one or as many as begin within the time; false if interrupted.
  bool Go() {
    Progress progress(isatty(STDERR_FILENO) != 0);
    for (;; ++plan_.passes) {
      RunMissing(progress);
      if (Interrupted() || WallSeconds() - start_ >= 60 * options_.minutes) break;
    }
    progress.Finish();
    return !Interrupted();
  }

  const fuzz::Plan& Plan() const { return plan_; }

  // In the order of the plan.
  std::vector<Json> Cells() const {
    std::vector<Json> cells;
    for (const fuzz::Cell& cell : CellsOf(plan_)) {
      if (const auto at = done_.find(cell.Name()); at != done_.end()) cells.push_back(at->second);
    }
    return cells;
  }

  void Write(const std::vector<fuzz::Reported>& findings) const {
    if (!file_) return;
    const std::size_t all = CellsOf(plan_).size();
    const std::vector<Json> cells = Cells();
    Json json = ResultHead(CommandWords(), plan_.seed, cells.size() < all);
    json["fuzz"] = ToJson(plan_, all, cells, findings);
    file_->Commit(Dump(json, Detail::kWithHistograms));
  }

 private:
  void RunMissing(Progress& progress) {
    std::vector<fuzz::Cell> missing;
    std::size_t number = 0;
    for (const fuzz::Cell& cell : CellsOf(plan_)) {
      const bool is_mine = number++ % shard_.count == shard_.index - 1;
      if (is_mine && !done_.contains(cell.Name())) missing.push_back(cell);
    }
    progress.Start(fmt::format("pass {}", plan_.passes), missing.size() * plan_.each);
    double written = WallSeconds();
    fuzz::RunOptions how;
    how.processes = options_.run.Threads();
    fuzz::Run(plan_, missing, how, [&](const fuzz::Cell& cell, Json json) {
      done_[cell.Name()] = std::move(json);
      progress.Advance(plan_.each);
      if (!options_.resume || WallSeconds() - written < kCheckpointSeconds) return;
      Write({});
      written = WallSeconds();
    });
  }

  const FuzzOptions& options_;
  std::optional<OutputFile>& file_;
  fuzz::Plan plan_;
  Done done_;
  Shard shard_;
  double start_;
};

// A file for each finding, that fuzz/corpus can take.
void WriteCorpus(const std::string& folder, const std::vector<fuzz::Reported>& findings) {
  for (const auto& [finding, example] : findings) {
    if (finding.what == "crash") continue;
    std::string name = finding.cell.energy->name;
    std::ranges::replace(name, '/', '-');
    OutputFile("--corpus", fmt::format("{}/{}-{}-{}.csv", folder, name, finding.cell.family->name,
                                       finding.what))
        .Commit(CorpusText(FuzzCommand(finding), finding.what, *finding.cell.energy, example));
  }
}

// The largest known of one figure, a climb for each row and family.
int RunClimb(const FuzzOptions& options) {
  const auto slope = std::ranges::find(fuzz::AllSlopes(), *options.climb, &fuzz::Slope::name);
  if (slope == fuzz::AllSlopes().end()) {
    std::string names;
    for (const fuzz::Slope& s : fuzz::AllSlopes()) {
      names += fmt::format("\n  {:<12} {}", s.name, s.meaning);
    }
    throw UsageError(fmt::format("--climb '{}': expected one of{}", *options.climb, names));
  }
  std::optional<OutputFile> file;
  if (options.json) file.emplace("--json", *options.json);
  const auto rows = RowsMatching(options.kernels);
  const auto families = FamiliesOf(options);
  const std::uint64_t climbs = rows.size() * families.size();
  const std::uint64_t evaluations = CeilDivide<std::uint64_t>(options.run.Count(), climbs);
  Progress progress(isatty(STDERR_FILENO) != 0);
  progress.Start(fmt::format("climb {}", slope->name), climbs * evaluations);
  const auto summits = ClimbAll(rows, families, *slope, options.run.Seed(), evaluations,
                                options.run.Threads(), [&] { progress.Advance(evaluations); });
  progress.Finish();
  if (options.json != "-") fmt::print("{}", ToTable(*slope, summits));
  if (file) {
    Json json = ResultHead(CommandWords(), options.run.Seed(), Interrupted());
    json["largest"] = ToJson(*slope, evaluations, summits);
    file->Commit(Dump(json, Detail::kWithHistograms));
  }
  return Interrupted() ? kInterrupted : kOk;
}

int RunZoo() {
  bool all = true;
  fmt::print("{:<18}{:<48}{:<10}{:<24}{:>6}\n", "exhibit", "what is wrong with it", "breaks",
             "first seen in", "after");
  for (const fuzz::Exhibit& exhibit : fuzz::Exhibits()) {
    const double start = WallSeconds();
    const std::optional<fuzz::Finding> finding = fuzz::Catch(exhibit);
    fmt::print("{:<18}{:<48}{:<10}{:<24}{:>4.2f} s\n", exhibit.name, exhibit.mistake,
               finding ? finding->what : "ESCAPED", finding ? finding->cell.Distribution() : "-",
               WallSeconds() - start);
    all = all && finding;
  }
  return all ? kOk : kBroken;
}

// An earlier result as Markdown, or what of it is worth publishing as JSON.
int ShowEarlier(const std::string& path, const std::optional<std::string>& json) {
  const Json result = ReadResult("--from", path);
  std::optional<OutputFile> file;
  if (json) file.emplace("--json", *json);
  try {
    if (!file) {
      fmt::print("{}", fuzz::ToMarkdown(result));
    } else {
      file->Commit(Dump(fuzz::Summary(result), Detail::kWithHistograms));
    }
  } catch (const Json::exception& error) {
    throw UsageError(
        fmt::format("--from '{}': expected a result of definite fuzz: {}", path, error.what()));
  }
  return kOk;
}

int RunFuzz(const FuzzOptions& options) {
  if (options.zoo) return RunZoo();
  if (options.climb) return RunClimb(options);
  if (options.from) return ShowEarlier(*options.from, options.json);
  if (options.list) {
    fmt::print("{}", fuzz::FamilyTable());
    return kOk;
  }
  std::optional<OutputFile> file;
  if (options.json) file.emplace("--json", *options.json);
  if (options.corpus && !std::filesystem::is_directory(*options.corpus)) {
    throw UsageError(fmt::format("--corpus '{}': expected a folder", *options.corpus));
  }
  FuzzRun run(options, file);
  const bool whole = run.Go();
  const std::vector<Json> cells = run.Cells();
  if (options.json != "-") fmt::print("{}", ToTable(run.Plan(), cells));
  std::vector<fuzz::Reported> findings;
  for (fuzz::Finding& finding : FindingsOf(run.Plan(), cells)) {
    fuzz::Reported reported{std::move(finding), {}};
    std::fputs(ToText(reported).c_str(), stderr);
    if (whole && reported.finding.what != "crash") reported.example = Shrunk(reported.finding);
    findings.push_back(std::move(reported));
  }
  run.Write(findings);
  if (options.corpus && whole) WriteCorpus(*options.corpus, findings);
  if (!whole) {
    std::fputs("definite: interrupted; the result is partial: what was complete by then\n", stderr);
    return kInterrupted;
  }
  return findings.empty() ? kOk : kBroken;
}

}  // namespace

void AddFuzz(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<FuzzOptions>();
  CLI::App* command =
      app.add_subcommand("fuzz", "Hunts degenerate configurations that break a filter");
  AddKernelsOption(*command, options->kernels);
  command
      ->add_option("--families", options->families,
                   "Only these families of configurations (may be repeated; see --list)")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  AddRunOptions(*command, options->run);
  command
      ->add_option("--minutes", options->minutes,
                   "Begin passes with further seeds until so much time is gone")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  AddJsonOption(*command, options->json);
  command->add_option("--shard", options->shard, "Only part I of N of the cells, such as 2/7")
      ->type_name("I/N");
  command->add_flag("--resume", options->resume,
                    "Keep complete cells in the --json FILE, every 20 s, and begin from there");
  command
      ->add_option("--corpus", options->corpus,
                   "Write each finding, made simple, to a file in FOLDER, which replay,\n"
                   "sweep and advise read")
      ->type_name("FOLDER");
  command->add_flag("--list", options->list, "Show the families and stop");
  command
      ->add_option("--from", options->from,
                   "Only write an earlier result as Markdown: who fails where; with --json,\n"
                   "as a summary without its cells")
      ->type_name("FILE");
  command
      ->add_option("--climb", options->climb,
                   "Look for the largest of a figure instead, for each row: distance, excess,\n"
                   "psd_defect, relabelling or rounding; --count is shared out")
      ->type_name("FIGURE");
  command->add_flag("--zoo", options->zoo,
                    "Hunt filters that are known to be bad, and see that each is caught");
  command->footer(
      "Families draw configurations near a degeneracy: delta from 1 to 1e-16, and 0. A cell is "
      "one\n"
      "energy in one decade of one family; each is judged in a process of its own, and a case "
      "that\n"
      "crashes or hangs is a finding like others. A promise that is broken exits 1, with the\n"
      "command that replays it; the JSON has the simplest configuration that shows it.\n\n"
      "Examples:\n"
      "  definite fuzz --quick\n"
      "  definite fuzz --kernels '*/signed/*' --families edge_angle --families sliver\n"
      "  definite fuzz --count 1e8 --resume --json fuzz.json\n"
      "  definite fuzz --minutes 30 --seed 1000 --corpus found\n"
      "  definite fuzz --climb relabelling --kernels '*/analytic/f64'");
  command->callback([options, &exit_code] { exit_code = RunFuzz(*options); });
}

}  // namespace definite
