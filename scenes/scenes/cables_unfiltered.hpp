#pragma once

#include "scenes/cables.hpp"

namespace definite::scenes {

struct CablesUnfiltered {
  static constexpr std::string_view kName = "cables_unfiltered";
  static constexpr std::string_view kClaim =
      "Without a filter implicit cables fail; with any filter they hold";
  static constexpr std::string_view kUses =
      "two cables of 3 segments, 12 degrees of freedom: edge-edge contact that remembers no sides, "
      "and springs that pull; "
      "unfiltered is the paper's Hessian of frozen parameters (unsigned_frozen)";
  static constexpr std::string_view kDiffers =
      "two cables in place of two bundles, springs in place of strands; the paper gives no masses";

  static Case Of(const char* length, const char* filter, double mu) {
    return {length, filter, mu, 1, 0, ""};
  }
  static Case SmallSteps() {
    Case c = Of("unsigned_frozen", "none", 1);
    c.substeps = 20;
    return c;
  }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all;
    for (const double mu : {0.3, 1., 10.}) {
      const Case none = Of("unsigned_frozen", "none", mu);
      all.push_back({Criterion::kFraction, Figure::kFails, none, 0.9, 1});
      all.push_back({Criterion::kFraction, Figure::kIndefinite, none, 1e-9, 1});
      for (const char* filter :
           {"gauss_newton", "analytic", "split", "nearest", "numeric", "absolute", "blend_half"}) {
        const Case filtered = Of("unsigned_frozen", filter, mu);
        all.push_back({Criterion::kMedian, Figure::kEnergy, filtered, 0, 0.1});
        all.push_back({Criterion::kFraction, Figure::kPops, filtered, 0, 0});
        all.push_back({Criterion::kFraction, Figure::kIndefinite, filtered, 0, 0});
      }
    }
    // Twenty times smaller steps hold without a filter.
    all.push_back({Criterion::kFraction, Figure::kFails, SmallSteps(), 0, 0.05});
    // The exact Hessians do not need a filter here.
    for (const char* length : {"signed", "hybrid", "unsigned"}) {
      all.push_back({Criterion::kFraction, Figure::kFails, Of(length, "none", 1), 0, 0.05});
    }
    return all;
  }
  static std::vector<Change> Changes() { return ChangesOf(Settings()); }
  static std::vector<Case> Contrast() {
    return {Of("unsigned_frozen", "none", 1), Of("unsigned_frozen", "none", 0.3),
            Of("unsigned_frozen", "analytic", 1), SmallSteps()};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  static bool Fails(const Outcome& o) {
    return o[Figure::kBooms] > 0 || o[Figure::kPops] > 0 || o[Figure::kJitters] > 0;
  }
  static Cables Settings() {
    Cables cables;
    cables.rest = 0.9;
    cables.rayleigh = 0.006;
    return cables;
  }
  static Trial Make(const Case& c, Draws& draws) { return MakeCables(Settings(), c, draws); }
};

}  // namespace definite::scenes

DEFINITE_SCENE(CablesUnfiltered);
