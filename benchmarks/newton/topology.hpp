#pragma once

// How the triangles of a surface hang together.

#include <stdexcept>
#include <vector>

#include "benchmarks/newton/mesh.hpp"

namespace definite::newton {

// A surface that cannot be laid out. The message says where, and what was expected.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Corner i of triangle e is 3 e + i, and begins the edge to the next corner.
constexpr int NextCorner(int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

// An edge between vertices a < b with the corners that begin it in its triangles; second is -1 at
// the boundary.
struct Edge {
  int a, b, first, second;
};

// In ascending order. Throws MeshError where an edge has more than two triangles, or two that turn
// it the same way.
std::vector<Edge> EdgesOf(const Mesh& mesh);

// The vertices of each boundary, in the order of its triangles.
std::vector<std::vector<int>> BoundariesOf(const Mesh& mesh);

// Things that are joined are one.
class Classes {
 public:
  explicit Classes(int count);
  void Join(int a, int b);
  // A number for each thing, from 0 on, by the first of its class.
  std::vector<int> Numbers();

 private:
  int RootOf(int a);

  std::vector<int> parent_;
};

}  // namespace definite::newton
