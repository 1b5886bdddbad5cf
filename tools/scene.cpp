// definite scene: minimal implicit scenes, in which claims about filters show up or do not.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/report.hpp"
#include "scenes/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

struct SceneOptions {
  std::string name, seed = "42";
  std::optional<std::string> starts, threads, filter, json, record, from;
  bool quick = false, map = false, ablate = false, list = false;
};

std::vector<const scenes::Scene*> ScenesOf(const SceneOptions& options) {
  std::vector<const scenes::Scene*> chosen;
  for (const scenes::Scene& scene : scenes::AllScenes()) {
    if (options.name == "all" || options.name == scene.name) chosen.push_back(&scene);
  }
  if (!chosen.empty()) return chosen;
  std::string known;
  for (const scenes::Scene& scene : scenes::AllScenes()) known += fmt::format("\n  {}", scene.name);
  throw UsageError(fmt::format("NAME '{}': expected all or one of{}", options.name, known));
}

scenes::Plan ScenePlan(const SceneOptions& options) {
  scenes::Plan plan;
  plan.seed = ParseCount("--seed", options.seed, 0);
  // An ablation tells fractions apart to a tenth.
  const std::string usual = options.quick ? "8" : options.ablate ? "100" : "40";
  plan.starts = ParseCount("--starts", options.starts.value_or(usual), 1, 100000);
  plan.threads = ThreadsOf(options.threads);
  plan.filter = options.filter;
  if (options.filter && !scenes::IsFilter(*options.filter)) {
    throw UsageError(fmt::format(
        "--filter '{}': expected a filter of collision energies (definite list), on_demand or "
        "progressive",
        *options.filter));
  }
  return plan;
}

// The runs that a scene is asked for.
std::size_t RunsOf(const scenes::Scene& scene, const SceneOptions& options,
                   const scenes::Plan& plan) {
  std::size_t cases = scenes::CasesOf(scene, plan).size();
  if (options.map) cases += scenes::MapCases(scene, plan).size();
  if (options.ablate) cases += scene.contrast().size() * (1 + scene.changes().size());
  return cases * plan.starts;
}

// False if interrupted.
bool RunOne(const SceneOptions& options, const scenes::Plan& plan, scenes::Reported& reported) {
  const scenes::Scene& scene = *reported.scene;
  reported.result = scenes::RunScene(scene, plan);
  if (!reported.result) return false;
  if (options.ablate) {
    reported.ablations = scenes::Ablate(scene, plan);
    if (!reported.ablations) return false;
  }
  if (!options.map) return true;
  reported.map = scenes::RunCases(scene, scenes::MapCases(scene, plan), plan);
  if (!reported.map) return false;
  auto errors = scenes::ErrorsOf(scene, *reported.map, plan);
  if (errors) reported.errors = std::move(*errors);
  return errors.has_value();
}

nlohmann::ordered_json SceneJson(const scenes::Plan& plan, std::size_t all,
                                 const std::vector<scenes::Reported>& reported) {
  nlohmann::ordered_json json = ResultHead(CommandWords(), plan.seed, reported.size() < all);
  json["scenes"] = scenes::ToJson(plan, all, reported);
  return json;
}

// The contacts that all starts of the scene's contrast meet.
int RecordContacts(const SceneOptions& options, const scenes::Scene& scene,
                   const scenes::Plan& plan) {
  OutputFile file("--record", *options.record);
  scenes::Recorder recorder;
  const std::vector<scenes::Case> contrast = scene.contrast();
  for (const scenes::Case& c : contrast) {
    for (std::uint64_t start = 0; start < plan.starts && !Interrupted(); ++start) {
      scene.run(c, plan.seed, start, &recorder);
    }
  }
  std::string command = "definite";
  for (std::size_t i = 1; i < CommandWords().size(); ++i) command += " " + CommandWords()[i];
  const scenes::Contacts contacts = scene.make(contrast.front(), plan.seed, 0).model.contacts;
  if (recorder.side.empty()) {
    throw UsageError(fmt::format("--record: '{}' has met no contact to record", scene.name));
  }
  file.Commit(scenes::RecordedText(command, contacts, recorder));
  fmt::print("{} contacts in {}\n", WithCommas(recorder.side.size()), *options.record);
  return Interrupted() ? kInterrupted : kOk;
}

int RunScenes(const SceneOptions& options) {
  if (options.list) {
    fmt::print("{}", scenes::SceneTable());
    return kOk;
  }
  if (options.from) {
    const auto result = ReadResult("--from", *options.from);
    try {
      fmt::print("{}", scenes::ToMarkdown(result));
    } catch (const nlohmann::json::exception& error) {
      throw UsageError(fmt::format("--from '{}': expected a result of definite scene: {}",
                                   *options.from, error.what()));
    }
    return kOk;
  }
  const std::vector<const scenes::Scene*> chosen = ScenesOf(options);
  scenes::Plan plan = ScenePlan(options);
  if (options.record) {
    if (chosen.size() > 1) throw UsageError("--record: expected one scene, not all");
    return RecordContacts(options, *chosen.front(), plan);
  }
  std::optional<OutputFile> file;
  if (options.json) file.emplace("--json", *options.json);
  Progress progress(isatty(STDERR_FILENO) != 0);
  plan.advance = [&progress] { progress.Advance(1); };
  std::vector<scenes::Reported> reported;
  for (const scenes::Scene* scene : chosen) {
    const std::size_t runs = RunsOf(*scene, options, plan);
    if (runs == 0) {
      throw UsageError(fmt::format("--filter '{}': no criterion of {} is about it; --map is",
                                   *plan.filter, scene->name));
    }
    progress.Start(std::string(scene->name), runs);
    scenes::Reported one{scene, {}, {}, {}, {}};
    const bool whole = RunOne(options, plan, one);
    progress.Finish();
    if (!whole) break;
    if (options.json != "-") fmt::print("{}", scenes::ToTable(one));
    std::fflush(stdout);
    reported.push_back(std::move(one));
  }
  if (file)
    file->Commit(Dump(SceneJson(plan, chosen.size(), reported),
                      options.map ? Detail::kWithHistograms : Detail::kSummaries));
  if (reported.size() < chosen.size()) {
    std::fputs("definite: interrupted; the result is partial: the scenes that were complete\n",
               stderr);
    return kInterrupted;
  }
  return kOk;
}

}  // namespace

void AddScene(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand("scene", "Runs minimal scenes in which claims show up");
  command->add_option("name", options->name, "A scene, or all (default: all)")->type_name("NAME");
  options->name = "all";
  CLI::Option* starts =
      command->add_option("--starts", options->starts, "Random starts of each case (default: 40)")
          ->type_name("N");
  command->add_flag("--quick", options->quick, "The same as --starts 8")->excludes(starts);
  AddSeedOption(*command, options->seed);
  AddThreadsOption(*command, options->threads);
  command->add_option("--filter", options->filter, "Only cases with this filter")
      ->type_name("NAME");
  command->add_flag("--ablate", options->ablate,
                    "And remove each term of a scene, add those left out (100 starts)");
  command->add_flag("--map", options->map,
                    "And failing fractions over mu = dt^2 k / m and filters");
  command
      ->add_option("--record", options->record,
                   "Write the contacts met to FILE.csv, which sweep and advise read")
      ->type_name("FILE");
  AddJsonOption(*command, options->json);
  command->add_flag("--list", options->list, "Show the scenes and stop");
  command->add_option("--from", options->from, "Only write an earlier result as Markdown")
      ->type_name("FILE");
  command->footer(
      "A scene states a claim of Shi & Kim 2023 and criteria that were fixed before it ran; the\n"
      "verdict says how many hold: reproduced, partly, not. That is a finding, and exits 0.\n\n"
      "Examples:\n"
      "  definite scene all\n"
      "  definite scene cables_popping --starts 100 --seed 7\n"
      "  definite scene cables_signed --map --json map.json\n"
      "  definite scene cables_popping --ablate\n"
      "  definite scene cables_popping --record contacts.csv\n"
      "  definite advise contacts.csv");
  command->callback([options, &exit_code] { exit_code = RunScenes(*options); });
}

}  // namespace definite
