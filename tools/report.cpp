// definite report: results as one page, which works from disk.

#include "fuzz/report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string_view>

#include "benchmarks/plans/plan.hpp"
#include "benchmarks/speed/speed.hpp"
#include "scenes/report.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"
#include "tools/page_template.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDataMark = "/*data*/";
constexpr const char* kFigures[] = {"distance", "excess", "rounding", "psd_defect", "relabelling"};

struct ReportOptions {
  std::vector<std::string> files;
  std::string out;
  bool history = false;
};

Json Only(const Json& object, std::initializer_list<const char*> keys) {
  Json part;
  for (const char* key : keys) part[key] = object.at(key);
  return part;
}

// What the charts show of a row: not the coordinates of its worst cases.
Json ShownOf(const Json& row) {
  Json shown = Only(row, {"kernel", "energy", "filter", "scalar", "source", "distribution", "count",
                          "active", "verdicts"});
  if (row.contains("set")) shown["set"] = row.at("set");
  shown["timing"] = Json::array();
  for (const Json& timing : row.at("timing")) {
    shown["timing"].push_back(Only(timing, {"pairs", "threads", "ns_per_hessian", "ratio_to"}));
  }
  for (const char* name : kFigures) {
    const Json& figure = row.at("accuracy").at(name);
    Json& to = shown["accuracy"][name];
    if (figure.is_null()) continue;
    to = Only(figure, {"count", "median", "p99"});
    to["max"] = Only(figure.at("max"), {"value", "index"});
  }
  Json& distance = shown["accuracy"]["distance"];
  if (!distance.is_null()) {
    distance["histogram"] = row.at("accuracy").at("distance").at("histogram");
  }
  return shown;
}

// What the charts show of scenes: not the runs behind each criterion.
Json ShownScenes(const Json& scenes) {
  Json shown = Json::array();
  for (const Json& scene : scenes.at("scenes")) {
    shown.push_back(Only(scene, {"name", "claim"}));
    for (const char* key : {"map", "prediction"}) {
      if (scene.contains(key)) shown.back()[key] = scene.at(key);
    }
  }
  return shown;
}

// The tables that the command which made the result prints; null if there are none.
Json TablesOf(const Json& result, const std::string& path) {
  try {
    if (result.contains("speed")) return ToMarkdown(result);
    if (result.contains("scenes")) return scenes::ToMarkdown(result);
    for (const Plan& plan : AllPlans()) {
      if (result.value("paper", Json()) == plan.name) return plan.markdown(result);
    }
  } catch (const std::exception& error) {
    // Of some of the rows only: there is enough for charts.
    fmt::print(stderr, "definite: FILE '{}': without its tables: {}\n", path, error.what());
  }
  return nullptr;
}

Json PageDataOf(const std::string& path) {
  const Json result = ReadResult("FILE", path);
  try {
    Json shown = Only(result, {"seed", "protocol", "build", "partial"});
    for (const char* key : {"command", "machine", "speed"}) {
      if (result.contains(key)) shown[key] = result.at(key);
    }
    shown["rows"] = Json::array();
    for (const Json& row : result.at("rows")) shown["rows"].push_back(ShownOf(row));
    if (result.contains("scenes")) shown["scenes"] = ShownScenes(result.at("scenes"));
    if (result.contains("fuzz")) shown["maps"] = fuzz::DegeneracyMaps(result.at("fuzz"));
    const Json tables = TablesOf(result, path);
    if (shown["rows"].empty() && !shown.contains("speed") && !shown.contains("maps") &&
        tables.is_null()) {
      throw UsageError(
          fmt::format("FILE '{}': it has nothing to draw; expected a result of sweep, speed, "
                      "reproduce, fuzz or scene",
                      path));
    }
    return {{"file", std::filesystem::path(path).filename().string()},
            {"markdown", tables},
            {"json", shown}};
  } catch (const Json::exception& error) {
    throw UsageError(
        fmt::format("FILE '{}': not as results/schema.json has it: {}", path, error.what()));
  }
}

// Times over several runs mean something on one machine only.
void CheckHistory(const std::vector<std::string>& files, const Json& results) {
  if (files.size() < 2) throw UsageError("--history: expected two FILEs or more, in their order");
  const auto shown_of = [&](std::size_t i) -> const Json& { return results.at(i).at("json"); };
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!shown_of(i).contains("machine")) {
      throw UsageError(fmt::format("--history: FILE '{}' has no times", files[i]));
    }
    for (const char* key : {"cpu", "cores"}) {
      const Json &first = shown_of(0).at("machine").at(key),
                 &here = shown_of(i).at("machine").at(key);
      if (first != here) {
        throw UsageError(fmt::format(
            "--history: FILE '{}' is of another machine: its {} is {}, of '{}' it is {}; expected "
            "runs of one",
            files[i], key, here.dump(), files[0], first.dump()));
      }
    }
  }
}

// The template with the data in it. A script ends at "</script", wherever that stands.
std::string Page(const Json& data) {
  const std::string_view page = PageTemplate();
  const std::size_t mark = page.find(kDataMark);
  std::string text(page.substr(0, mark));
  for (const char c : data.dump()) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text += page.substr(mark + kDataMark.size());
}

int RunReportCommand(const ReportOptions& options) {
  if (PageTemplate().empty()) {
    throw UsageError("report: this program was built without the page, for want of npm");
  }
  OutputFile out("--out", options.out);
  Json results = Json::array();
  for (const std::string& path : options.files) results.push_back(PageDataOf(path));
  if (options.history) CheckHistory(options.files, results);
  out.Commit(Page({{"results", results}, {"history", options.history}}));
  return kOk;
}

}  // namespace

void AddReport(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Draws results: cost against error, as one page for a browser");
  command->add_option("FILE", options->files, "Results of sweep, speed, reproduce, fuzz or scene")
      ->required();
  command->add_option("--out", options->out, "The page, one file that needs no network")
      ->type_name("FILE")
      ->required();
  command->add_flag("--history", options->history,
                    "FILEs are runs of one machine, in their order: a chart has their times,\n"
                    "the other charts are of the last");
  command->footer(
      "Examples:\n"
      "  definite reproduce shi-kim-2023 --quick --json result.json\n"
      "  definite report result.json --out report.html\n"
      "  definite report results/published/shi-kim-2023.json speed.json --out report.html\n"
      "  definite scene cables_popping --map --json map.json\n"
      "  definite report map.json --out report.html\n"
      "  definite report --history monday.json tuesday.json --out report.html");
  command->callback([options, &exit_code] { exit_code = RunReportCommand(*options); });
}

}  // namespace definite
