#pragma once

// Results of scenes as tables at 100 columns, as JSON (results/schema.json, "scenes") and as
// Markdown.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/predict.hpp"

namespace definite::scenes {

// What was asked of a scene; empty where it was not.
struct Reported {
  const Scene* scene = nullptr;
  std::optional<SceneResult> result;
  std::optional<std::vector<Ablation>> ablations;
  std::optional<std::vector<CaseResult>> map;
  std::vector<std::optional<Errors>> errors;  // of the map's cells
};

std::string ToTable(const Reported& reported);
nlohmann::ordered_json ToJson(const Plan& plan, std::size_t all_scenes,
                              const std::vector<Reported>& scenes);

// What docs/scenes.md quotes, of a whole result.
std::string ToMarkdown(const nlohmann::ordered_json& result);

// Scenes with what they claim and use.
std::string SceneTable();

// Contacts met, as benchmarks/harness/sampling/recorded.hpp reads them.
std::string RecordedText(const std::string& command, const Contacts& contacts,
                         const Recorder& recorder);

}  // namespace definite::scenes
