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
std::vector<int> JoinCorners(const Mesh& mesh, const std::vector<Edge>& edges,
                             const std::vector<bool>& cut) {
  Classes corners(3 * mesh.Elements());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int first = edges[i].first, second = edges[i].second;
    if (second < 0 || cut[i]) continue;
    // They run through it in opposite directions.
    corners.Join(first, NextCorner(second));
    corners.Join(NextCorner(first), second);
  }
  return corners.Numbers();
}

// Finds where to cut; edges by their number.
class Cutter {
 public:
  explicit Cutter(const Mesh& mesh)
      : mesh_(mesh), edges_(EdgesOf(mesh)), at_vertex_(mesh.rest.size()) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      at_vertex_[static_cast<std::size_t>(edges_[i].a)].push_back(i);
      at_vertex_[static_cast<std::size_t>(edges_[i].b)].push_back(i);
    }
  }

  // Whether each edge is cut; those of the boundary are.
  std::vector<bool> Cut() const {
    std::vector<int> tips;
    int root = 0;
    if (IsClosed()) {
      tips = Tips();
      root = tips.front();
    }
    std::vector<bool> cut = NotCrossed(ShortestPaths({root}).edges);
    Prune(tips, cut);
    return cut;
  }

 private:
  struct Paths {
    std::vector<double> length;
    std::vector<bool> edges;  // that some path uses: a tree for each source
  };

  bool IsBoundary(std::size_t edge) const { return edges_[edge].second < 0; }
  bool IsClosed() const {
    return std::ranges::none_of(edges_, [](const Edge& edge) { return edge.second < 0; });
  }

  // Dijkstra's. Boundaries have no length: paths go once to each of them, and never through the
  // surface between two of its vertices.
  Paths ShortestPaths(const std::vector<int>& sources) const {
    constexpr auto kNone = std::numeric_limits<std::size_t>::max();
    std::vector<double> length(mesh_.rest.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> last(mesh_.rest.size(), kNone);  // edge of the path to a vertex
    using Reached = std::pair<double, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    for (const int source : sources) {
      length[static_cast<std::size_t>(source)] = 0;
      queue.emplace(0, source);
    }
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (so_far > length[static_cast<std::size_t>(v)]) continue;
      for (const std::size_t edge : at_vertex_[static_cast<std::size_t>(v)]) {
        const int w = edges_[edge].a + edges_[edge].b - v;
        const double through = so_far + (IsBoundary(edge) ? 0 : Norm(mesh_.At(w) - mesh_.At(v)));
        if (through >= length[static_cast<std::size_t>(w)]) continue;
        length[static_cast<std::size_t>(w)] = through;
        last[static_cast<std::size_t>(w)] = edge;
        queue.emplace(through, w);
      }
    }
    Paths paths{std::move(length), std::vector<bool>(edges_.size(), false)};
    for (const std::size_t edge : last) {
      if (edge != kNone) paths.edges[edge] = true;
    }
    return paths;
  }

  // Each the farthest from those before it; the first, from vertex 0.
  std::vector<int> Tips() const {
    std::vector<int> tips;
    for (int i = 0; i < kTips; ++i) {
      const Paths paths = ShortestPaths(tips.empty() ? std::vector{0} : tips);
      const auto farthest = std::ranges::max_element(paths.length);
      tips.push_back(static_cast<int>(farthest - paths.length.begin()));
    }
    return tips;
  }

  // All edges but those that join triangles to a tree; it crosses none of `uncrossed`.
  std::vector<bool> NotCrossed(const std::vector<bool>& uncrossed) const {
    std::vector<std::size_t> edge_of(static_cast<std::size_t>(3 * mesh_.Elements()));
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      edge_of[static_cast<std::size_t>(edges_[i].first)] = i;
      if (!IsBoundary(i)) edge_of[static_cast<std::size_t>(edges_[i].second)] = i;
    }
    std::vector<bool> result(edges_.size(), true);
    std::vector<bool> reached(static_cast<std::size_t>(mesh_.Elements()), false);
    std::queue<int> queue({0});
    reached[0] = true;
    while (!queue.empty()) {
      const int triangle = queue.front();
      queue.pop();
      for (int corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
        const std::size_t edge = edge_of[static_cast<std::size_t>(corner)];
        if (IsBoundary(edge) || uncrossed[edge]) continue;
        const int next = (edges_[edge].first + edges_[edge].second - corner) / 3;
        if (reached[static_cast<std::size_t>(next)]) continue;
        reached[static_cast<std::size_t>(next)] = true;
        result[edge] = false;
        queue.push(next);
      }
    }
    return result;
  }

  // Sews up what ends inside the surface at a vertex that is no tip.
  void Prune(const std::vector<int>& tips, std::vector<bool>& cut) const {
    std::vector<int> count(mesh_.rest.size(), 0);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (!cut[i]) continue;
      ++count[static_cast<std::size_t>(edges_[i].a)];
      ++count[static_cast<std::size_t>(edges_[i].b)];
    }
    for (int begin = 0; begin < mesh_.Vertices(); ++begin) {
      for (int v = begin;
           count[static_cast<std::size_t>(v)] == 1 && !std::ranges::count(tips, v);) {
        const auto& around = at_vertex_[static_cast<std::size_t>(v)];
        const std::size_t edge =
            *std::ranges::find_if(around, [&](std::size_t i) { return cut[i]; });
        cut[edge] = false;
        --count[static_cast<std::size_t>(v)];
        v = edges_[edge].a + edges_[edge].b - v;
        --count[static_cast<std::size_t>(v)];
      }
    }
  }

  const Mesh& mesh_;
  const std::vector<Edge> edges_;
  std::vector<std::vector<std::size_t>> at_vertex_;
};

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
      FromCorners(mesh, JoinCorners(mesh, edges, std::vector<bool>(edges.size(), false)));
  const std::set<int> used(mesh.elements.begin(), mesh.elements.end());
  if (joined.rest.size() > used.size()) {
    throw MeshError(fmt::format(
        "expected triangles around each vertex that are joined by edges, found {} vertices more",
        joined.rest.size() - used.size()));
  }
  return FromCorners(joined, JoinCorners(joined, EdgesOf(joined), Cutter(joined).Cut()));
}

}  // namespace definite::newton
