#pragma once

// Penalties of the distance between two edges.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/closest_edges.hpp"
#include "kernels/penalties/quadratic.hpp"

namespace definite {

DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kEnvelope>, Quadratic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kFrozen>, Quadratic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kHybrid>, Quadratic>);

}  // namespace definite
