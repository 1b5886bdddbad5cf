#pragma once

// Many starts of a scene's cases, what its criteria say of them, ablations and maps. A start is
// named by (scene, seed, number), so that no result hangs on the number of threads.

#include <functional>
#include <optional>
#include <utility>

#include "scenes/intervals.hpp"
#include "scenes/scene.hpp"

namespace definite::scenes {

struct Plan {
  std::uint64_t seed = 42, starts = 40;
  int threads = 1;
  std::optional<std::string> filter;  // only cases with this filter
  // Called after each run, by any thread.
  std::function<void()> advance = [] {};
};

// A case with the outcomes of all its starts, in their order.
struct CaseResult {
  Case of;
  std::vector<Outcome> starts;

  std::vector<bool> Event(Figure figure) const;
  std::uint64_t Count(Figure figure) const;
  // The figures that starts have, ascending.
  std::vector<double> Sorted(Figure figure) const;
};

struct Judgement {
  Criterion criterion;
  // What came out: a fraction with its interval, a median, the two ends of a number, or a p value.
  double value = 0, low = 0, high = 0;
  bool holds = false;
};

enum class Verdict { kReproduced, kPartly, kNot };
std::string_view NameOf(Verdict verdict);

struct SceneResult {
  const Scene* scene = nullptr;
  std::vector<CaseResult> cases;
  std::vector<Judgement> judgements;
  std::optional<Verdict> verdict;  // none where only some of the criteria were asked
};

// One for each case of the criteria; null if interrupted.
std::vector<Case> CasesOf(const Scene& scene, const Plan& plan);
std::optional<SceneResult> RunScene(const Scene& scene, const Plan& plan);

// What one change does to one case of the contrast.
struct Ablation {
  Change change;
  CaseResult with, without;  // as the scene is, and changed
  Interval difference;       // of the failing fraction, changed less not
  enum Effect { kNoChange, kChanged, kUndecided } effect;
};
std::string_view NameOf(Ablation::Effect effect);

// "No change": the interval lies within +- this.
inline constexpr double kSameFraction = 0.1;

std::optional<std::vector<Ablation>> Ablate(const Scene& scene, const Plan& plan);

// Failing fractions over mu, for each length and filter of the map.
std::vector<double> MapMus();
std::vector<std::string> MapFilters();
std::vector<Case> MapCases(const Scene& scene, const Plan& plan);
std::optional<std::vector<CaseResult>> RunCases(const Scene& scene, const std::vector<Case>& cases,
                                                const Plan& plan);

}  // namespace definite::scenes
