#pragma once

// Penalties of the distance between two edges.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/closest_edges.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/log_barrier.hpp"
#include "kernels/penalties/quadratic.hpp"

namespace definite {

template <Clamped kKind>
inline constexpr bool kStaged<Collision<ClosestEdges<kKind>, Quadratic>> = true;

DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kEnvelope>, Quadratic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kEnvelope>, Cubic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kEnvelope>, LogBarrier>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kFrozen>, Quadratic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kFrozen>, Cubic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kFrozen>, LogBarrier>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kHybrid>, Quadratic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kHybrid>, Cubic>);
DEFINITE_ENERGY(Collision<ClosestEdges<Clamped::kHybrid>, LogBarrier>);

}  // namespace definite
