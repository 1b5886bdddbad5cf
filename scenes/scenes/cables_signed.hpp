#pragma once

#include "scenes/cables.hpp"

namespace definite::scenes {

struct CablesSigned {
  static constexpr std::string_view kName = "cables_signed";
  static constexpr std::string_view kClaim =
      "A signed length jitters, whatever the filter, and the hybrid length does not";
  static constexpr std::string_view kUses =
      "two cables of 5 segments, 24 degrees of freedom: edge-edge contact, and springs under "
      "tension at rest already";
  static constexpr std::string_view kDiffers =
      "two cables in place of two bundles, springs in place of strands; the paper gives no masses; "
      "it sees less jitter with its filter than with Gauss-Newton";

  static Case Of(const char* length, const char* filter, int substeps = 1) {
    return {length, filter, 3, substeps, 0, ""};
  }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all;
    for (const char* filter : {"gauss_newton", "analytic", "numeric", "absolute"}) {
      all.push_back({Criterion::kFraction, Figure::kJitters, Of("signed", filter), 0.15, 0.6});
      all.push_back({Criterion::kFraction, Figure::kJitters, Of("hybrid", filter), 0, 0});
      all.push_back({Criterion::kDiffers, Figure::kJitters, Of("signed", filter), 0, 1,
                     Of("hybrid", filter)});
    }
    all.push_back({Criterion::kNoMatter, Figure::kJitters, Of("signed", "gauss_newton"), 0, 1,
                   Of("signed", "analytic")});
    // With twenty times smaller steps it is still there: it is the energy's.
    all.push_back({Criterion::kDiffers, Figure::kJitters, Of("signed", "analytic", 20), 0, 1,
                   Of("hybrid", "analytic", 20)});
    return all;
  }
  static std::vector<Change> Changes() { return ChangesOf(Settings()); }
  static std::vector<Case> Contrast() {
    return {Of("signed", "analytic"), Of("hybrid", "analytic"), Of("hybrid", "analytic", 20)};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  static bool Fails(const Outcome& o) {
    return o[Figure::kBooms] > 0 || o[Figure::kPops] > 0 || o[Figure::kJitters] > 0;
  }
  static Cables Settings() {
    Cables cables;
    cables.segments = 5;
    cables.displacement = 0.5;
    cables.rest = 0.9;
    cables.rayleigh = 0.006;
    cables.offset = 0.07;  // nearer to the middle more starts jitter
    return cables;
  }
  static Trial Make(const Case& c, Draws& draws) { return MakeCables(Settings(), c, draws); }
};

}  // namespace definite::scenes

DEFINITE_SCENE(CablesSigned);
