#pragma once

// Penalties of the distance of a vertex to the plane of a face.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/unsigned_plane.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/log_barrier.hpp"
#include "kernels/penalties/quadratic.hpp"
#include "kernels/stencils/vertex_face.hpp"

namespace definite {

template <>
inline constexpr bool kStaged<Collision<UnsignedPlane<VertexFace>, Quadratic>> = true;

DEFINITE_ENERGY(Collision<UnsignedPlane<VertexFace>, Quadratic>);
DEFINITE_ENERGY(Collision<UnsignedPlane<VertexFace>, Cubic>);
DEFINITE_ENERGY(Collision<UnsignedPlane<VertexFace>, LogBarrier>);

}  // namespace definite
