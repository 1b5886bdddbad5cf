#pragma once

// Surfaces opened until they are disks.

#include "benchmarks/newton/topology.hpp"

namespace definite::newton {

// A disk as it is. A closed surface of genus 0 is cut along a tree of shortest paths between
// vertices that lie far from each other. Throws MeshError for any other surface: parts that are not
// joined, triangles that meet in a vertex alone, several boundaries, handles.
Mesh MakeDiskOf(const Mesh& mesh);

}  // namespace definite::newton
