// definite doctor: what a time measured here is worth.

#include "benchmarks/harness/doctor.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "benchmarks/harness/machine.hpp"
#include "tools/command_line.hpp"
#include "tools/output_file.hpp"

namespace definite {

namespace {

constexpr const char* kTrustNames[] = {"good", "care", "bad"};

std::string Coloured(Trust trust, const std::string& text) {
  if (!isatty(STDOUT_FILENO)) return text;
  constexpr const char* kColours[] = {"32", "33", "31"};
  return fmt::format("\033[{}m{}\033[0m", kColours[static_cast<int>(trust)], text);
}

std::string Lines(const std::vector<Symptom>& symptoms, int width) {
  std::string text;
  for (const Symptom& s : symptoms) {
    text += fmt::format("  {:<{}} {}\n", s.name, width, Coloured(s.trust, s.found));
    if (!s.means.empty()) text += fmt::format("  {:<{}} - {}\n", "", width, s.means);
  }
  return text;
}

nlohmann::ordered_json ToJson(const std::vector<Symptom>& symptoms) {
  auto json = nlohmann::ordered_json::array();
  for (const Symptom& s : symptoms) {
    json.push_back({{"name", s.name},
                    {"found", s.found},
                    {"trust", kTrustNames[static_cast<int>(s.trust)]},
                    {"means", s.means}});
  }
  return json;
}

int RunDoctorCommand(const std::optional<std::string>& path) {
  std::optional<OutputFile> file;
  if (path) file.emplace("--json", *path);
  const Diagnosis diagnosis = Diagnose();
  const nlohmann::ordered_json machine = DescribeMachine(std::nullopt, false);
  if (path != "-") {
    fmt::print(
        "{}, {} cores, {}\n\n{}\nTrust its times for\n{}",
        machine.at("cpu").is_null() ? "unknown processor" : machine.at("cpu").get<std::string>(),
        machine.at("cores").get<int>(), machine.at("os").get<std::string>(),
        Lines(diagnosis.symptoms, 10), Lines(diagnosis.verdicts, 44));
  }
  if (file) {
    const nlohmann::ordered_json json = {{"cpu", machine.at("cpu")},
                                         {"cores", machine.at("cores")},
                                         {"noise_typical", diagnosis.typical},
                                         {"noise_floor", diagnosis.floor},
                                         {"symptoms", ToJson(diagnosis.symptoms)},
                                         {"trust", ToJson(diagnosis.verdicts)}};
    file->Commit(json.dump(1) + "\n");
  }
  return kOk;
}

}  // namespace

void AddDoctor(CLI::App& app, int& exit_code) {
  const auto path = std::make_shared<std::optional<std::string>>();
  CLI::App* command = app.add_subcommand("doctor", "Says what times measured here are worth");
  AddJsonOption(*command, *path);
  command->footer(
      "Looks at the clock rate's governor and turbo, load, SMT, a container's quota and the "
      "clock,\n"
      "and times a row against itself. Takes a second.\n\n"
      "Examples:\n"
      "  definite doctor\n"
      "  definite doctor --json - | jq .noise_floor");
  command->callback([path, &exit_code] { exit_code = RunDoctorCommand(*path); });
}

}  // namespace definite
