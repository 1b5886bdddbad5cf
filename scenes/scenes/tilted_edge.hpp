#pragma once

#include "scenes/slopes.hpp"

namespace definite::scenes {

struct TiltedEdge {
  static constexpr std::string_view kName = "tilted_edge";
  static constexpr std::string_view kClaim =
      "A filtered unsigned length is sticky between edges only where they penetrate";
  static constexpr std::string_view kUses =
      "edge-edge contact that remembers sides, and a load, 6 degrees of freedom: no spring holds "
      "the free edge, for nothing parts it; case level: l/eps";
  static constexpr std::string_view kDiffers =
      "the paper shows stickiness in bundles of cables and in cloth";

  static Case Of(const char* length, const char* filter, double mu, double level) {
    return {length, filter, mu, 1, level, ""};
  }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all;
    for (const double mu : {0.1, 1., 10.}) {
      all.push_back({Criterion::kEach, Figure::kSlip, Of("unsigned_frozen", "analytic", mu, -0.3),
                     0.99, 1.01});
      for (const double level : {0.5, -0.3}) {
        all.push_back(
            {Criterion::kEach, Figure::kSlide, Of("signed", "analytic", mu, level), 0.98, 1.05});
      }
      all.push_back({Criterion::kEach, Figure::kSlide, Of("unsigned_frozen", "analytic", mu, 0.5),
                     0.98, 1.05});
    }
    all.push_back({Criterion::kEach, Figure::kSlide, Of("unsigned_frozen", "gauss_newton", 1, -0.3),
                   0.98, 1.05});
    // Uphill.
    all.push_back(
        {Criterion::kEach, Figure::kSlide, Of("unsigned_frozen", "none", 10, 0.5), -1, 0});
    return all;
  }
  static std::vector<Change> Changes() {
    std::vector<Change> changes = SlopeChanges(true);
    changes.push_back(
        {"side_memory", "no memory of sides", true, "without it nothing is ever penetrating"});
    return changes;
  }
  static std::vector<Case> Contrast() {
    return {Of("unsigned_frozen", "analytic", 1, -0.3), Of("signed", "analytic", 1, -0.3)};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  // Held back, or pushed.
  static bool Fails(const Outcome& o) {
    return !(o[Figure::kSlide] >= 0.9 && o[Figure::kSlide] <= 1.1);
  }
  static Trial Make(const Case& c, Draws& draws) { return EdgeOnSlope(c, draws); }
};

}  // namespace definite::scenes

DEFINITE_SCENE(TiltedEdge);
