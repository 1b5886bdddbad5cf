#include "benchmarks/newton/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace definite::newton {

std::vector<Edge> EdgesOf(const Mesh& mesh) {
  const auto vertex = [&](int corner) { return mesh.elements[static_cast<std::size_t>(corner)]; };
  std::vector<Edge> halves;
  for (int corner = 0; corner < 3 * mesh.Elements(); ++corner) {
    const auto [a, b] = std::minmax({vertex(corner), vertex(NextCorner(corner))});
    halves.push_back({a, b, corner, -1});
  }
  std::ranges::stable_sort(
      halves, [](const Edge& e, const Edge& f) { return e.a != f.a ? e.a < f.a : e.b < f.b; });
  std::vector<Edge> edges;
  for (const Edge& half : halves) {
    if (edges.empty() || edges.back().a != half.a || edges.back().b != half.b) {
      edges.push_back(half);
      continue;
    }
    Edge& edge = edges.back();
    const auto fail = [&](const char* what) {
      return MeshError(fmt::format("triangle {} at the edge of vertices {} and {}: {}",
                                   half.first / 3 + 1, edge.a + 1, edge.b + 1, what));
    };
    if (edge.second >= 0) throw fail("expected two triangles there, found a third");
    if (vertex(edge.first) == vertex(half.first)) {
      throw fail("expected it to be turned as its neighbour is");
    }
    edge.second = half.first;
  }
  return edges;
}

std::vector<std::vector<int>> BoundariesOf(const Mesh& mesh) {
  std::unordered_map<int, int> next;
  std::vector<int> begins;
  for (const Edge& edge : EdgesOf(mesh)) {
    if (edge.second >= 0) continue;
    const int from = mesh.elements[static_cast<std::size_t>(edge.first)];
    begins.push_back(from);
    next[from] = mesh.elements[static_cast<std::size_t>(NextCorner(edge.first))];
  }
  std::vector<std::vector<int>> boundaries;
  for (const int begin : begins) {
    if (!next.contains(begin)) continue;
    std::vector<int>& loop = boundaries.emplace_back();
    for (auto at = next.find(begin); at != next.end(); at = next.find(loop.back())) {
      const int to = at->second;
      next.erase(at);
      loop.push_back(to);
    }
  }
  return boundaries;
}

Classes::Classes(int count) : parent_(static_cast<std::size_t>(count)) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int Classes::RootOf(int a) {
  int* parent = &parent_[static_cast<std::size_t>(a)];
  while (*parent != a) {
    *parent = parent_[static_cast<std::size_t>(*parent)];
    a = *parent;
    parent = &parent_[static_cast<std::size_t>(a)];
  }
  return a;
}

void Classes::Join(int a, int b) {
  const auto [low, high] = std::minmax({RootOf(a), RootOf(b)});
  parent_[static_cast<std::size_t>(high)] = low;
}

std::vector<int> Classes::Numbers() {
  std::vector<int> numbers(parent_.size(), -1);
  int next = 0;
  // The root of a class is its least member.
  for (int a = 0; a < static_cast<int>(parent_.size()); ++a) {
    const int root = RootOf(a);
    numbers[static_cast<std::size_t>(a)] =
        root == a ? next++ : numbers[static_cast<std::size_t>(root)];
  }
  return numbers;
}

}  // namespace definite::newton
