#include "benchmarks/newton/cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <set>

namespace definite::newton {

namespace {

constexpr int kTips = 6;  // ends of the cut: a head and the limbs of a figure

// The mesh whose vertices are classes of corners.
Mesh FromCorners(const Mesh& mesh, const std::vector<int>& vertex_of_corner) {
  Mesh result;
  result.elements = vertex_of_corner;
  result.rest.resize(static_cast<std::size_t>(1 + *std::ranges::max_element(vertex_of_corner)));
  for (std::size_t corner = 0; corner < vertex_of_corner.size(); ++corner) {
    result.rest[static_cast<std::size_t>(vertex_of_corner[corner])] =
        mesh.At(mesh.elements[corner]);
  }
  return result;
}

// Corners are one vertex where triangles share an edge that is not cut.
template <class IsCut>
std::vector<int> JoinCorners(const Mesh& mesh, const std::vector<Edge>& edges, IsCut is_cut) {
  Classes corners(3 * mesh.Elements());
  for (const Edge& edge : edges) {
    if (edge.second < 0 || is_cut(edge)) continue;
    // They run through it in opposite directions.
    corners.Join(edge.first, NextCorner(edge.second));
    corners.Join(NextCorner(edge.first), edge.second);
  }
  return corners.Numbers();
}

struct Paths {
  std::vector<double> length;
  std::vector<int> before;  // the vertex before it on the way from a source; -1 for a source
};

// Dijkstra along edges.
Paths ShortestPaths(const Mesh& mesh, const std::vector<Edge>& edges,
                    const std::vector<int>& sources) {
  const auto count = mesh.rest.size();
  std::vector<std::vector<int>> neighbours(count);
  for (const Edge& edge : edges) {
    neighbours[static_cast<std::size_t>(edge.a)].push_back(edge.b);
    neighbours[static_cast<std::size_t>(edge.b)].push_back(edge.a);
  }
  Paths paths{std::vector<double>(count, std::numeric_limits<double>::infinity()),
              std::vector<int>(count, -1)};
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (const int source : sources) {
    paths.length[static_cast<std::size_t>(source)] = 0;
    queue.emplace(0, source);
  }
  while (!queue.empty()) {
    const auto [length, v] = queue.top();
    queue.pop();
    if (length > paths.length[static_cast<std::size_t>(v)]) continue;
    for (const int w : neighbours[static_cast<std::size_t>(v)]) {
      const double through = length + Norm(mesh.At(w) - mesh.At(v));
      if (through < paths.length[static_cast<std::size_t>(w)]) {
        paths.length[static_cast<std::size_t>(w)] = through;
        paths.before[static_cast<std::size_t>(w)] = v;
        queue.emplace(through, w);
      }
    }
  }
  return paths;
}

int FarthestOf(const Paths& paths) {
  return static_cast<int>(std::ranges::max_element(paths.length) - paths.length.begin());
}

// The edges of shortest paths from one far vertex to others, each farthest from those before it.
std::set<std::pair<int, int>> CutTree(const Mesh& mesh, const std::vector<Edge>& edges) {
  std::vector<int> tips = {FarthestOf(ShortestPaths(mesh, edges, {0}))};
  const Paths paths = ShortestPaths(mesh, edges, tips);
  std::set<std::pair<int, int>> tree;
  for (int tip = 1; tip < kTips; ++tip) {
    tips.push_back(FarthestOf(ShortestPaths(mesh, edges, tips)));
    int v = tips.back();
    for (int w; (w = paths.before[static_cast<std::size_t>(v)]) >= 0; v = w) {
      tree.insert(std::minmax(v, w));
    }
  }
  return tree;
}

void CheckJoined(const Mesh& mesh, const std::vector<Edge>& edges) {
  Classes parts(mesh.Elements());
  for (const Edge& edge : edges) {
    if (edge.second >= 0) parts.Join(edge.first / 3, edge.second / 3);
  }
  const std::vector<int> numbers = parts.Numbers();
  const int count = 1 + *std::ranges::max_element(numbers);
  if (count > 1) throw MeshError(fmt::format("expected one surface, found {} parts", count));
}

}  // namespace

Mesh MakeDiskOf(const Mesh& mesh) {
  const std::vector<Edge> edges = EdgesOf(mesh);
  CheckJoined(mesh, edges);
  const Mesh joined =
      FromCorners(mesh, JoinCorners(mesh, edges, [](const Edge&) { return false; }));
  std::set<int> used(mesh.elements.begin(), mesh.elements.end());
  if (joined.rest.size() > used.size()) {
    throw MeshError(fmt::format(
        "expected triangles around each vertex that are joined by edges, found {} vertices more",
        joined.rest.size() - used.size()));
  }
  const auto boundaries = static_cast<int>(BoundariesOf(joined).size());
  if (boundaries > 1) {
    throw MeshError(fmt::format("expected one boundary or none, found {}", boundaries));
  }
  const int genus = (2 - boundaries - EulerCharacteristic(joined)) / 2;
  if (genus > 0) {
    throw MeshError(fmt::format("expected a surface of genus 0, found genus {}", genus));
  }
  if (boundaries == 1) return joined;
  const std::vector<Edge> joined_edges = EdgesOf(joined);
  const auto tree = CutTree(joined, joined_edges);
  return FromCorners(joined, JoinCorners(joined, joined_edges, [&tree](const Edge& edge) {
                       return tree.contains({edge.a, edge.b});
                     }));
}

}  // namespace definite::newton
