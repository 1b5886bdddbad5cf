#pragma once

#include "benchmarks/harness/sampling/distribution.hpp"

namespace definite::distributions {

struct Normal {
  static constexpr std::string_view kName = "normal";
  static constexpr std::string_view kDescription = "all coordinates iid N(0,1), eps = 1";
  static constexpr ParameterValue kParameters[] = {{"k", 1}, {"eps", 1}, {"side", 0}};

  static bool Supports(std::string_view) { return true; }

  static void DrawCoordinates(const DrawTarget& target, Draws& draws, double* x) {
    for (int i = 0; i < target.dofs; ++i) x[i] = draws.Normal();
  }
};

}  // namespace definite::distributions

DEFINITE_DISTRIBUTION(Normal);
