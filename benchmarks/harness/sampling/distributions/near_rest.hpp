#pragma once

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/sampling/simplex.hpp"

namespace definite::distributions {

struct NearRest {
  static constexpr std::string_view kName = "near_rest";
  static constexpr std::string_view kDescription =
      "triangles and tetrahedra next to rest: F = Q (I + 0.05 N), N iid N(0,1)";
  static constexpr std::span<const ParameterValue> kParameters{};

  static bool Supports(std::string_view stencil) { return IsSimplex(stencil); }

  static void DrawCoordinates(const DrawTarget& target, Draws& draws, double* x) {
    PutJittered(0.05, draws, DimensionOf(target.stencil), x);
  }
};

}  // namespace definite::distributions

DEFINITE_DISTRIBUTION(NearRest);
