#include "benchmarks/newton/layout.hpp"

#include <fmt/format.h>

#include <Eigen/Sparse>
#include <cmath>
#include <numbers>
#include <set>

namespace definite::newton {

std::array<double, 6> FlattenTriangle(const Mesh& mesh, int e) {
  const int* const v = mesh.Element(e);
  const Point a = mesh.At(v[1]) - mesh.At(v[0]), b = mesh.At(v[2]) - mesh.At(v[0]);
  const double length = Norm(a);
  return {0, 0, length, 0, Dot(a, b) / length, Norm(Cross(a, b)) / length};
}

namespace {

// Angles at which the boundary's vertices stand; the second of the pair is the number of the one
// next to pi, which is put there.
std::pair<std::vector<double>, std::size_t> AnglesOf(const Mesh& mesh,
                                                     const std::vector<int>& boundary) {
  std::vector<double> way = {0};
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const int next = boundary[(i + 1) % boundary.size()];
    way.push_back(way.back() + Norm(mesh.At(next) - mesh.At(boundary[i])));
  }
  const double whole = way.back();
  way.pop_back();
  std::size_t half = 1;
  for (std::size_t i = 1; i < way.size(); ++i) {
    if (std::abs(way[i] - whole / 2) < std::abs(way[half] - whole / 2)) half = i;
  }
  // Each half of the boundary has a half of the circle.
  std::vector<double> angles;
  for (std::size_t i = 0; i < way.size(); ++i) {
    angles.push_back(i < half
                         ? std::numbers::pi * way[i] / way[half]
                         : std::numbers::pi * (1 + (way[i] - way[half]) / (whole - way[half])));
  }
  return {angles, half};
}

double AreaOf(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
}

// Each vertex that is not `held` into the mean of its neighbours.
void Relax(const std::vector<Edge>& edges, const std::vector<bool>& held,
           std::vector<PlanePoint>& points) {
  std::vector<int> number(held.size(), -1);
  int free = 0;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) number[v] = free++;
  }
  if (free == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(free, 2);
  const auto add = [&](int from, int to) {
    const int row = number[static_cast<std::size_t>(from)];
    const int column = number[static_cast<std::size_t>(to)];
    if (row < 0) return;
    entries.emplace_back(row, row, 1);
    if (column >= 0) {
      entries.emplace_back(row, column, -1);
    } else {
      const PlanePoint& point = points[static_cast<std::size_t>(to)];
      right.row(row) += Eigen::RowVector2d(point[0], point[1]);
    }
  };
  for (const Edge& edge : edges) {
    add(edge.a, edge.b);
    add(edge.b, edge.a);
  }
  Eigen::SparseMatrix<double> laplacian(free, free);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(laplacian);
  const Eigen::MatrixXd solution = ldlt.solve(right);
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) points[v] = {solution(number[v], 0), solution(number[v], 1)};
  }
}

}  // namespace

Embedding EmbedDisk(const Mesh& mesh) {
  const std::vector<Edge> edges = EdgesOf(mesh);
  const std::vector<int> boundary = BoundariesOf(mesh).front();
  const auto [angles, half] = AnglesOf(mesh, boundary);
  double area = 0;
  for (int e = 0; e < mesh.Elements(); ++e) area += MeasureOf(mesh, e);
  Embedding embedding{std::vector<PlanePoint>(mesh.rest.size()), boundary[half], boundary[0]};
  std::vector<bool> held(mesh.rest.size(), false);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto v = static_cast<std::size_t>(boundary[i]);
    held[v] = true;
    embedding.points[v] = {std::cos(angles[i]), std::sin(angles[i])};
  }
  embedding.points[static_cast<std::size_t>(embedding.left)] = {-1, 0};
  Relax(edges, held, embedding.points);

  const auto area_of = [&](int e) {
    const auto point = [&](int i) {
      return embedding.points[static_cast<std::size_t>(mesh.Element(e)[i])];
    };
    return AreaOf(point(0), point(1), point(2));
  };
  double drawn = 0;
  for (int e = 0; e < mesh.Elements(); ++e) {
    if (!(area_of(e) > 0)) {
      throw MeshError(fmt::format("triangle {}: expected an area in Tutte's embedding, found {:g}",
                                  e + 1, area_of(e)));
    }
    drawn += area_of(e);
  }
  const double scale = std::sqrt(area / drawn);
  for (PlanePoint& point : embedding.points) point = {scale * point[0], scale * point[1]};
  return embedding;
}

}  // namespace definite::newton
