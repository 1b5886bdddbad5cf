#pragma once

#include "scenes/slopes.hpp"

namespace definite::scenes {

struct TiltedVertex {
  static constexpr std::string_view kName = "tilted_vertex";
  static constexpr std::string_view kClaim =
      "A filtered unsigned length is sticky (vertex-face): slip u tan(theta) a step, whatever k "
      "and m";
  static constexpr std::string_view kUses =
      "vertex-face contact and gravity, 3 degrees of freedom: nothing else can hold the vertex";
  static constexpr std::string_view kDiffers =
      "the paper shows stickiness in bundles of cables and in cloth";

  static Case Of(const char* length, const char* filter, double mu) {
    return {length, filter, mu, 1, 0, ""};
  }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all = {
        {Criterion::kEach, Figure::kSlip, Of("unsigned", "analytic", 0.1), 0.99, 1.01}};
    for (const double mu : {0.1, 1., 10.}) {
      all.push_back({Criterion::kEach, Figure::kSlide, Of("signed", "analytic", mu), 0.98, 1.05});
      all.push_back({Criterion::kEach, Figure::kSlide, Of("unsigned", "analytic", mu), 0, 0.6});
    }
    for (const char* filter : {"gauss_newton", "nearest"}) {
      all.push_back({Criterion::kEach, Figure::kSlide, Of("unsigned", filter, 1), 0.98, 1.05});
    }
    return all;
  }
  static std::vector<Change> Changes() {
    std::vector<Change> changes = SlopeChanges(false);
    changes.push_back({"side_memory", "the scene remembers sides", false, "nothing penetrates"});
    return changes;
  }
  static std::vector<Case> Contrast() {
    return {Of("unsigned", "analytic", 1), Of("signed", "analytic", 1)};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned"}; }
  // Held back, or pushed.
  static bool Fails(const Outcome& o) {
    return !(o[Figure::kSlide] >= 0.9 && o[Figure::kSlide] <= 1.1);
  }
  static Trial Make(const Case& c, Draws& draws) { return VertexOnSlope(c, draws); }
};

}  // namespace definite::scenes

DEFINITE_SCENE(TiltedVertex);
