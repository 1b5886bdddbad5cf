#pragma once

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/sampling/simplex.hpp"

namespace definite::distributions {

struct Inverted {
  static constexpr std::string_view kName = "inverted";
  static constexpr std::string_view kDescription =
      "inside out: stretches in [1/2, 2), the last one in (-2, 0)";
  static constexpr std::span<const ParameterValue> kParameters{};

  static bool Supports(std::string_view stencil) { return IsSimplex(stencil); }

  static void DrawCoordinates(const DrawTarget& target, Draws& draws, double* x) {
    const std::array<double, 3> s = {0.5 + 1.5 * draws.Uniform(), 0.5 + 1.5 * draws.Uniform(),
                                     -2 * draws.OpenUniform()};
    if (target.stencil == "triangle") return PutStretched({s[0], s[2], 0}, draws, 2, x);
    PutStretched(s, draws, 3, x);
  }
};

}  // namespace definite::distributions

DEFINITE_DISTRIBUTION(Inverted);
