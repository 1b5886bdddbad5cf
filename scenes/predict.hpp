#pragma once

// Whether what a filter gets wrong tells where a scene fails: its error on the contacts that the
// scene meets, beside the failing fraction.

#include <optional>
#include <span>
#include <vector>

#include "scenes/run.hpp"

namespace definite::scenes {

// Of a row, over contacts met in runs with the analytic filter, of the same length and mass.
struct Errors {
  std::size_t contacts = 0;
  // Medians, 0 where they are no more than rounding, relative to the nearest PSD matrix P: |F - P|,
  // and what it makes of the step of one contact by itself, |(M/dt^2 + F)^-1 g - (M/dt^2 + P)^-1 g|
  // (docs/protocol.md, section 1).
  double distance = 0, step_error = 0;
};

// One for each case of a map; none where its filter is no row of the registry. Null if interrupted.
std::optional<std::vector<std::optional<Errors>>> ErrorsOf(const Scene& scene,
                                                           const std::vector<CaseResult>& map,
                                                           const Plan& plan);

// Spearman's rank correlation of failing fraction and error over the filters of one length and
// mass, its mean over those where not all fail alike.
struct Prediction {
  int groups = 0;
  double distance = 0, step_error = 0;
};
Prediction PredictionOf(const std::vector<CaseResult>& map,
                        std::span<const std::optional<Errors>> errors);

// Between -1 and 1; ties share their ranks. NaN where one side is all alike.
double RankCorrelation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace definite::scenes
