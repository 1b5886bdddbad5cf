#pragma once

// Penalties of the signed length.

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/signed.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/log_barrier.hpp"
#include "kernels/penalties/quadratic.hpp"
#include "kernels/stencils/edge_edge.hpp"
#include "kernels/stencils/vertex_face.hpp"

namespace definite {

template <class Primitive>
inline constexpr bool kStudied<Collision<Signed<Primitive>, Quadratic>> = true;
template <class Primitive>
inline constexpr bool kStudied<Collision<Signed<Primitive>, LogBarrier>> = true;

DEFINITE_ENERGY(Collision<Signed<VertexFace>, Quadratic>);
DEFINITE_ENERGY(Collision<Signed<VertexFace>, Cubic>);
DEFINITE_ENERGY(Collision<Signed<VertexFace>, LogBarrier>);
DEFINITE_ENERGY(Collision<Signed<EdgeEdge>, Quadratic>);
DEFINITE_ENERGY(Collision<Signed<EdgeEdge>, Cubic>);
DEFINITE_ENERGY(Collision<Signed<EdgeEdge>, LogBarrier>);

}  // namespace definite
