#pragma once

#include <cmath>

#include "scenes/slopes.hpp"

namespace definite::scenes {

struct Resonance {
  static constexpr std::string_view kName = "resonance";
  static constexpr std::string_view kClaim =
      "Unfiltered frozen edges fail by a resonance, mu = u/(eps - u), and not by stiffness alone";
  static constexpr std::string_view kUses =
      "tilted_edge's edge and load, 6 degrees of freedom, a single step; case level: l/eps";
  static constexpr std::string_view kDiffers = "the paper reports that unfiltered scenes explode";

  static Case Of(const char* filter, double mu, double level) {
    return {"unsigned_frozen", filter, mu, 1, level, ""};
  }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all;
    for (const double level : {0.3, 0.5, 0.7}) {
      const double mu = level / (1 - level);
      all.push_back({Criterion::kEach, Figure::kPeak, Of("none", mu, level), 0.97, 1.03});
      all.push_back({Criterion::kFraction, Figure::kFails, Of("none", 1.02 * mu, level), 1, 1});
      all.push_back({Criterion::kFraction, Figure::kFails, Of("none", 0.1 * mu, level), 0, 0});
      all.push_back({Criterion::kFraction, Figure::kFails, Of("analytic", 1.02 * mu, level), 0, 0});
    }
    return all;
  }
  static std::vector<Change> Changes() {
    std::vector<Change> changes = SlopeChanges(true);
    changes.push_back({"side_memory", "the scene remembers sides", false, "nothing penetrates"});
    return changes;
  }
  static std::vector<Case> Contrast() { return {Of("none", 1.02, 0.5), Of("analytic", 1.02, 0.5)}; }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  // Uphill, or a step more than ten times too far.
  static bool Fails(const Outcome& o) {
    return !(o[Figure::kSlide] >= 0 && o[Figure::kSlide] <= 10);
  }
  // A single step, as a free one would go.
  static Trial Make(const Case& c, Draws& draws) {
    Trial trial = EdgeOnSlope(c, draws);
    const double acceleration = 2 * trial.watch.free_slide;  // in 1 s
    trial.frames = 1;
    trial.watch.free_slide = acceleration * trial.Dt() * trial.Dt();
    return trial;
  }
  // And where on an axis of mu, in steps of 1 %, the single step is longest.
  static Outcome Run(const Case& c, Draws& draws) {
    const Draws same = draws;
    Outcome outcome = Observe(Make(c, draws));
    if (c.filter != "none" || !c.change.empty()) return outcome;
    double longest = 0;
    for (int i = 0; i < 600; ++i) {
      Case at = c;
      at.mu = 0.05 * std::pow(1.01, i);
      Draws again = same;
      const Trial trial = Make(at, again);
      const double way = std::abs(Observe(trial)[Figure::kSlide] * trial.watch.free_slide);
      if (way <= longest) continue;
      longest = way;
      outcome[Figure::kPeak] = at.mu * (1 - c.level) / c.level;
    }
    return outcome;
  }
};

}  // namespace definite::scenes

DEFINITE_SCENE(Resonance);
