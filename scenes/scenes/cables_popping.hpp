#pragma once

#include "scenes/cables.hpp"

namespace definite::scenes {

struct CablesPopping {
  static constexpr std::string_view kName = "cables_popping";
  static constexpr std::string_view kClaim =
      "Gauss-Newton lets penetrating cables pop through where the filtered Hessian holds them";
  static constexpr std::string_view kUses =
      "two cables of 5 segments, 24 degrees of freedom: edge-edge contact that remembers sides, "
      "and springs strong enough to press the cables into each other";
  static constexpr std::string_view kDiffers =
      "two cables in place of two bundles, springs in place of strands; the paper gives no masses; "
      "what is held jitters, also in small steps";

  static Case Of(const char* length, const char* filter, int substeps = 1,
                 const char* change = "") {
    return {length, filter, 10, substeps, 0, change};
  }
  static std::vector<Criterion> Criteria() {
    const auto frozen = [](const char* filter, int substeps = 1, const char* change = "") {
      return Of("unsigned_frozen", filter, substeps, change);
    };
    std::vector<Criterion> all = {
        {Criterion::kFraction, Figure::kPops, frozen("gauss_newton"), 0.9, 1},
        {Criterion::kFraction, Figure::kPops, frozen("analytic"), 0, 0.05},
        {Criterion::kFraction, Figure::kPops, frozen("absolute"), 0, 0.05},
        {Criterion::kDiffers, Figure::kPops, frozen("gauss_newton"), 0, 1, frozen("analytic")}};
    // Held in small steps too: else the scene is overloaded.
    for (const char* filter : {"gauss_newton", "analytic", "absolute", "numeric"}) {
      all.push_back({Criterion::kFraction, Figure::kPops, frozen(filter, 20), 0, 0.05});
    }
    for (const char* filter : {"gauss_newton", "analytic"}) {
      all.push_back(
          {Criterion::kFraction, Figure::kPops, frozen(filter, 1, "side_memory"), 0.9, 1});
    }
    // The signed length pops too, with still smaller masses.
    const auto light = [](const char* filter, int substeps) {
      Case c = Of("signed", filter, substeps);
      c.mu = 30;
      return c;
    };
    all.push_back(
        {Criterion::kDiffers, Figure::kPops, light("gauss_newton", 1), 0, 1, light("analytic", 1)});
    all.push_back({Criterion::kFraction, Figure::kPops, light("gauss_newton", 20), 0, 0.05});
    // The hybrid is no safer.
    all.push_back(
        {Criterion::kDiffers, Figure::kPops, Of("hybrid", "analytic"), 0, 1, frozen("analytic")});
    return all;
  }
  static std::vector<Change> Changes() { return ChangesOf(Settings()); }
  static std::vector<Case> Contrast() {
    return {Of("unsigned_frozen", "gauss_newton"), Of("unsigned_frozen", "analytic"),
            Of("unsigned_frozen", "gauss_newton", 20)};
  }
  static std::vector<std::string> Lengths() { return {"signed", "unsigned_frozen", "hybrid"}; }
  // What is held jitters, so that jitter is no failure here.
  static bool Fails(const Outcome& o) { return o[Figure::kBooms] > 0 || o[Figure::kPops] > 0; }
  static Cables Settings() {
    Cables cables;
    cables.segments = 5;
    cables.displacement = 0.6;
    cables.stretch = 1.6;
    cables.rest = 0.9;
    cables.rayleigh = 0.006;
    cables.memory = Memory::kScene;
    return cables;
  }
  static Trial Make(const Case& c, Draws& draws) { return MakeCables(Settings(), c, draws); }
};

}  // namespace definite::scenes

DEFINITE_SCENE(CablesPopping);
