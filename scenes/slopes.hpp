#pragma once

// Something that slides down a slope without friction: what drag there is, is a filter's.

#include "scenes/scene.hpp"

namespace definite::scenes {

inline constexpr double kSlopeStiffness = 10, kSlopeEps = 0.09;  // N/m, m: the paper's, 5.2.1

// A vertex on a fixed triangle; gravity presses it to its equilibrium, where it begins at rest.
// The slope is drawn within 0.2 to 0.4 radians, its direction is anywhere.
Trial VertexOnSlope(const Case& c, Draws& draws);

// An edge, its two vertices free, across the middle of a fixed one that slopes; a load presses it
// to the length level x eps, where it begins at rest.
Trial EdgeOnSlope(const Case& c, Draws& draws);

// What an ablation of a slope removes and adds.
std::vector<Change> SlopeChanges(bool is_edge);

}  // namespace definite::scenes
