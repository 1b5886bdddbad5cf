#pragma once

// What is looked at in a run.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scenes/step.hpp"

namespace definite::scenes {

// Events are 0 or 1; NaN is what a scene does not look at, or what a run that ended early has not.
enum class Figure {
  kFails,       // what the scene calls failing
  kBooms,       // a vertex leaves the scene, or the matrix is singular, or a number is not finite
  kPops,        // at the end one primitive is through the other by more than 2 eps
  kPenetrates,  // at the end one is through by at most 2 eps, and held
  kJitters,     // jitter above its threshold
  kIndefinite,  // some matrix had a negative pivot
  kEnergy,      // greatest kinetic energy, in k eps^2
  kJitter,      // RMS of x(n+1) - 2 x(n) + x(n-1) over the end of the run, in eps
  kSlip,        // slip of the last step, in what is expected
  kSlide,       // way slid, in that without drag
  kSpacing,     // mean distance of neighbours in a bundle at frame 45, m
  kPeak,        // where a resonance is, in where it is expected
  kPivots,      // negative pivots, for each step
  kContacts,    // pairs in reach, for each step
  kSolves,      // factorizations, for each step
  kIterations,  // of conjugate gradients, for each step
  kCount,
};
inline constexpr std::size_t kFigures = static_cast<std::size_t>(Figure::kCount);
struct FigureInfo {
  std::string_view name;
  bool is_event;
  std::string_view meaning;
};
const FigureInfo& InfoOf(Figure figure);

struct Outcome {
  std::array<double, kFigures> of;
  // Of a step, s, and the kernels' share of it; no part of what must not vary.
  double step_seconds = 0, kernel_share = 0;

  Outcome();
  double& operator[](Figure f) { return of[static_cast<std::size_t>(f)]; }
  double operator[](Figure f) const { return of[static_cast<std::size_t>(f)]; }
};

// Threshold of jitter at dt = 1/30; it scales with dt^2.
inline constexpr double kJitterThreshold = 0.02;
inline constexpr double kFrame = 1. / 30;  // s

// What to look at; what is empty is not.
struct Watch {
  double span = 0;             // |x| beyond is a boom, m
  double jitter_from = 0;      // s
  bool crossings = false;      // edges seen from above: who is through whom at the end
  int spacing_neighbours = 0;  // vertices of `spacing` in groups of so many
  std::vector<int> spacing;
  std::vector<int> sliders;  // their mean is what slides, along `downhill`
  Point downhill = {0, 0, 0};
  double free_slide = 0;     // without drag in the time of the run, m
  double expected_slip = 0;  // in a step, m
};

struct Trial {
  Model model;
  Method method;
  Watch watch;
  int substeps = 1;  // of a frame
  int frames = 90;

  double Dt() const { return kFrame / substeps; }
};

// Contacts met, if asked for: called after each step with the pairs in reach.
struct Recorder {
  std::vector<double> x;  // 12 numbers for each
  std::vector<double> side;
};

// Runs a trial to its end, or to where it booms. Which figures make kFails is the caller's.
Outcome Observe(const Trial& trial, Recorder* recorder = nullptr);

}  // namespace definite::scenes
