#pragma once

// Bundles of cables against each other: what both sizes share.

#include "scenes/cables.hpp"

namespace definite::scenes {

// `kEach` cables of 3 segments in each of two bundles.
template <int kEach>
struct Bundles {
  static constexpr std::string_view kClaim =
      "Unfiltered bundles of cables fail, filtered ones hold; an unsigned length is sticky: it "
      "keeps cables closer";
  static constexpr std::string_view kDiffers =
      "cables of 3 segments, springs in place of strands; no contacts within a bundle; the paper "
      "gives no masses";

  static Case Of(const char* length, const char* filter) { return {length, filter, 1, 1, 0, ""}; }
  static std::vector<Criterion> Criteria() {
    std::vector<Criterion> all = {
        {Criterion::kFraction, Figure::kFails, Of("unsigned_frozen", "none"), 0.9, 1}};
    for (const char* length : {"unsigned_frozen", "signed", "hybrid"}) {
      all.push_back({Criterion::kFraction, Figure::kPops, Of(length, "analytic"), 0, 0.05});
      all.push_back({Criterion::kFraction, Figure::kIndefinite, Of(length, "analytic"), 0, 0});
    }
    // What sticks stays together; a twentieth is little.
    all.push_back({Criterion::kRatio, Figure::kSpacing, Of("unsigned_frozen", "analytic"), 0, 0.95,
                   Of("signed", "analytic")});
    return all;
  }
  static std::vector<Change> Changes() { return ChangesOf(Settings()); }
  static std::vector<Case> Contrast() {
    return {Of("unsigned_frozen", "none"), Of("unsigned_frozen", "analytic")};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  static bool Fails(const Outcome& o) {
    return o[Figure::kBooms] > 0 || o[Figure::kPops] > 0 || o[Figure::kJitters] > 0;
  }
  static Cables Settings() {
    Cables cables;
    cables.each = kEach;
    cables.stretch = 0.8 * kEach;
    return cables;
  }
  static Trial Make(const Case& c, Draws& draws) { return MakeCables(Settings(), c, draws); }
};

}  // namespace definite::scenes
