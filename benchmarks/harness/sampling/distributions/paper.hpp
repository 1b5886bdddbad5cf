#pragma once

#include "benchmarks/harness/sampling/distribution.hpp"

namespace definite::distributions {

// Source: Shi & Kim 2023, Table 1: random arrangements. The paper gives neither eps nor k.
struct Paper {
  static constexpr std::string_view kName = "paper";
  static constexpr std::string_view kDescription = "all coordinates iid uniform in [0,1), eps = 1";
  static constexpr ParameterValue kParameters[] = {{"k", 1}, {"eps", 1}, {"side", 0}};

  static bool Supports(std::string_view) { return true; }

  static void DrawCoordinates(const DrawTarget& target, Draws& draws, double* x) {
    for (int i = 0; i < target.dofs; ++i) x[i] = draws.Uniform();
  }
};

}  // namespace definite::distributions

DEFINITE_DISTRIBUTION(Paper);
