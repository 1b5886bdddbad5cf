#pragma once

// Disks in the plane: each triangle alone at rest, and all together as a first layout.

#include <array>
#include <vector>

#include "benchmarks/newton/topology.hpp"

namespace definite::newton {

using PlanePoint = std::array<double, 2>;

// Triangle e of a surface laid out isometrically: its first vertex in the origin, the second on the
// x axis, the third above it. Coordinates vertex by vertex.
std::array<double, 6> FlattenTriangle(const Mesh& mesh, int e);

// A disk in the plane: the boundary on a circle, its edges' shares of the arc as in space, and each
// other vertex in the mean of its neighbours. Its area is the surface's. No triangle is inverted,
// or MeshError says which one is, for lack of digits. The first vertex of the boundary and the one
// nearest to opposite it are on the x axis.
// Source: Tutte 1963, "How to draw a graph".
struct Embedding {
  std::vector<PlanePoint> points;
  int left, right;  // the two on the axis
};
Embedding EmbedDisk(const Mesh& mesh);

}  // namespace definite::newton
