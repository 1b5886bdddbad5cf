#pragma once

// Penalties of the distance of a vertex to an edge, and to another vertex.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/unsigned_line.hpp"
#include "kernels/lengths/unsigned_points.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/log_barrier.hpp"
#include "kernels/penalties/quadratic.hpp"

namespace definite {

DEFINITE_ENERGY(Collision<UnsignedLine, Quadratic>);
DEFINITE_ENERGY(Collision<UnsignedLine, Cubic>);
DEFINITE_ENERGY(Collision<UnsignedLine, LogBarrier>);
DEFINITE_ENERGY(Collision<UnsignedPoints, Quadratic>);
DEFINITE_ENERGY(Collision<UnsignedPoints, Cubic>);
DEFINITE_ENERGY(Collision<UnsignedPoints, LogBarrier>);

}  // namespace definite
