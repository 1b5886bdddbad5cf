#pragma once

// Surfaces opened until they are disks.

#include "benchmarks/newton/topology.hpp"

namespace definite::newton {

// A disk as it is; any other surface cut along a graph of shortest paths. A closed one is cut as
// far as some vertices that lie far from each other, too, for it would be crammed through one short
// slit otherwise. Throws MeshError for parts that are not joined, and for triangles that meet in a
// vertex alone. Source: Erickson and Whittlesey 2005, "Greedy optimal homotopy and homology
// generators": the graph is a tree of shortest paths with the edges that a tree of triangles beside
// it does not cross.
Mesh MakeDiskOf(const Mesh& mesh);

}  // namespace definite::newton
