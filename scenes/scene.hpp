#pragma once

// A scene: a claim, what it is made of, which runs show it, and what must come out.

#include <concepts>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/harness/sampling/random.hpp"
#include "scenes/observe.hpp"

namespace definite::scenes {

// One way to run a scene; many starts of it make the fractions.
struct Case {
  std::string length;  // of the contacts, as in the registry
  std::string filter;  // as Method::filter
  double mu = 1;       // dt^2 k / m at dt = 1/30 s: sets the masses
  int substeps = 1;    // of 1/30 s, masses as they are
  double level = 0;    // a parameter of the scene's own
  std::string change;  // the term that is removed or added; "" is the scene as it is

  std::string Label() const;
  bool operator==(const Case&) const = default;
};

// What must come out, fixed before running.
struct Criterion {
  enum Kind {
    kFraction,  // of an event lies within [low, high]
    kMedian,    // of a number lies within [low, high]
    kEach,      // value of a number, the least and the greatest, lies within
    kDiffers,   // the event is more frequent in `of` than in `beside`, Fisher's p < 0.05
    kRatio,     // the median over starts of a number in `of` over that in `beside` lies within
    kNoMatter,  // the event is as frequent in both: Fisher's p >= 0.05
  } kind;
  Figure figure;
  Case of;
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();
  Case beside = {};

  bool IsPair() const { return kind == kDiffers || kind == kRatio || kind == kNoMatter; }
};

// A term that an ablation removes, or adds.
struct Change {
  std::string_view name, meaning;
  bool is_removed;       // the scene has it; else it is added
  std::string_view why;  // the scene has it, or has it not
};

// What a file in scenes/ defines. Make turns a case and random draws into a trial: the same draws
// for all cases of a start.
template <class S>
concept SceneType = requires(const Case& c, Draws& draws) {
  { S::kName } -> std::convertible_to<std::string_view>;
  { S::kClaim } -> std::convertible_to<std::string_view>;
  { S::kUses } -> std::convertible_to<std::string_view>;     // energies and parameters, and why
  { S::kDiffers } -> std::convertible_to<std::string_view>;  // from the paper
  { S::Criteria() } -> std::same_as<std::vector<Criterion>>;
  { S::Changes() } -> std::same_as<std::vector<Change>>;
  { S::Contrast() } -> std::same_as<std::vector<Case>>;  // what an ablation must leave as it is
  { S::Lengths() } -> std::same_as<std::vector<std::string>>;  // of a map
  { S::Fails(Outcome()) } -> std::same_as<bool>;
  { S::Make(c, draws) } -> std::same_as<Trial>;
};

struct Scene {
  std::string_view name, claim, uses, differs;
  std::vector<Criterion> (*criteria)();
  std::vector<Change> (*changes)();
  std::vector<Case> (*contrast)();
  std::vector<std::string> (*lengths)();
  // One start of one case.
  Outcome (*run)(const Case& c, std::uint64_t seed, std::uint64_t start, Recorder* recorder);
  Trial (*make)(const Case& c, std::uint64_t seed, std::uint64_t start);
};

// In alphabetical order of their files.
std::span<const Scene> AllScenes();
const Scene* FindScene(std::string_view name);

template <SceneType S>
Trial MakeTrial(const Case& c, std::uint64_t seed, std::uint64_t start) {
  Draws draws(StreamId(S::kName), seed, start);
  return S::Make(c, draws);
}

template <SceneType S>
Outcome RunStart(const Case& c, std::uint64_t seed, std::uint64_t start, Recorder* recorder) {
  Outcome outcome;
  if constexpr (requires(Draws & draws) { S::Run(c, draws); }) {  // a search of its own
    Draws draws(StreamId(S::kName), seed, start);
    outcome = S::Run(c, draws);
  } else {
    outcome = Observe(MakeTrial<S>(c, seed, start), recorder);
  }
  outcome[Figure::kFails] = S::Fails(outcome);
  return outcome;
}

template <SceneType S>
Scene MakeScene() {
  return {S::kName,   S::kClaim,   S::kUses,   S::kDiffers, S::Criteria,
          S::Changes, S::Contrast, S::Lengths, RunStart<S>, MakeTrial<S>};
}

}  // namespace definite::scenes

// Stands last in each file of scenes/; CMake finds it there and adds a row to AllScenes().
#define DEFINITE_SCENE(Type) static_assert(::definite::scenes::SceneType<::definite::scenes::Type>)
