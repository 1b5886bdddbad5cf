#pragma once

// Surfaces of a user, as Wavefront OBJ.

#include <string>

#include "benchmarks/newton/topology.hpp"

namespace definite::newton {

// The lines `v` and `f`, polygons cut into triangles from their first vertex; all other lines are
// ignored. Throws MeshError, naming the line, where one is not understood or has no area.
Mesh ReadObj(const std::string& path);

}  // namespace definite::newton
