#include "benchmarks/advice/degeneracies.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/stencils/edge_edge.hpp"
#include "kernels/stencils/vertex_face.hpp"

namespace definite {

namespace {

using Point = Vec3<double>;

double Length(const Point& a) { return std::hypot(a[0], a[1], a[2]); }

// Two primitives of contact: their edges, and where they are beside each other.
struct Primitives {
  std::array<Point, 3> edges;  // all edges of both
  std::size_t count;
  // The lines or the plane they span: foot points in units of the edges, 0 and 1 being the ends,
  // and the distance.
  std::array<double, 3> foot;
  double sine, apart;

  double Longest() const {
    double longest = 0;
    for (std::size_t e = 0; e < count; ++e) longest = std::max(longest, Length(edges[e]));
    return longest;
  }
  double Shortest() const {
    double shortest = Longest();
    for (std::size_t e = 0; e < count; ++e) shortest = std::min(shortest, Length(edges[e]));
    return shortest;
  }
};

// Of two lines through the origin and through `between`, or of a plane and a point: where `between`
// = foot[0] a + foot[1] b + apart n.
void Place(const Point& a, const Point& b, const Point& between, Primitives& primitives) {
  const Point across = Cross(a, b);
  const double area = Length(across);
  const Point n = (1 / area) * across;
  primitives.sine = area / Length(a) / Length(b);
  primitives.apart = Dot(n, between);
  primitives.foot[0] = Dot(Cross(b, n), between) / area;
  primitives.foot[1] = Dot(Cross(n, a), between) / area;
}

// In units of a power of two near the longest component between vertices: products neither over-
// nor underflow, and nothing is rounded.
template <int kDofs>
Vec<double, kDofs> InOwnUnit(const double* x) {
  double longest = 0;
  for (int i = 3; i < kDofs; ++i) longest = std::max(longest, std::abs(x[i] - x[i % 3]));
  const int exponent = longest > 0 ? std::ilogb(longest) : 0;
  Vec<double, kDofs> scaled;
  for (int i = 0; i < kDofs; ++i) scaled[i] = std::ldexp(x[i], -exponent);
  return scaled;
}

Primitives PrimitivesOf(std::string_view stencil, const double* x) {
  Primitives primitives = {};
  if (stencil == VertexFace::kName) {
    const auto [e0, e1, e2] = VertexFace::EdgesOf(InOwnUnit<12>(x));
    primitives.edges = {e0, e1, e1 - e0};
    primitives.count = 3;
    Place(e0, e1, e2, primitives);
    primitives.foot[2] = 1 - primitives.foot[0] - primitives.foot[1];
  } else if (stencil == EdgeEdge::kName) {
    const auto [e0, e1, e2] = EdgeEdge::EdgesOf(InOwnUnit<12>(x));
    primitives.edges = {e0, e1};
    primitives.count = 2;
    Place(e0, e1, e2, primitives);
    primitives.foot[1] *= -1;  // the other line runs towards the foot, not away from it
  } else {
    const Vec<double, 9> scaled = InOwnUnit<9>(x);
    const Point edge = Vertex(scaled, 2) - Vertex(scaled, 1),
                between = Vertex(scaled, 0) - Vertex(scaled, 1);
    primitives.edges = {edge};
    primitives.count = 1;
    primitives.foot[0] = Dot(edge, between) / Dot(edge, edge);
    primitives.apart = Length(Cross(edge, between)) / Length(edge);
  }
  return primitives;
}

double EdgeAngle(std::string_view stencil, const double* x) {
  return PrimitivesOf(stencil, x).sine;
}

double ShortEdge(std::string_view stencil, const double* x) {
  const Primitives primitives = PrimitivesOf(stencil, x);
  const double longest = primitives.Longest();
  return longest > 0 ? primitives.Shortest() / longest : 0;
}

double Sliver(std::string_view stencil, const double* x) {
  const Primitives primitives = PrimitivesOf(stencil, x);
  const double longest = primitives.Longest();
  return Length(Cross(primitives.edges[0], primitives.edges[1])) / longest / longest;
}

double Touching(std::string_view stencil, const double* x) {
  const Primitives primitives = PrimitivesOf(stencil, x);
  return std::abs(primitives.apart) / primitives.Longest();
}

double Tiny(std::string_view stencil, const double* x) {
  const Primitives primitives = PrimitivesOf(stencil, x);
  return primitives.Shortest() / std::abs(primitives.apart);
}

double FarFoot(std::string_view stencil, const double* x) {
  double farthest = 0;
  for (const double foot : PrimitivesOf(stencil, x).foot) {
    farthest = std::max(farthest, std::abs(foot));
  }
  return 1 / farthest;
}

constexpr std::string_view kFace[] = {"vertex_face"}, kEdges[] = {"edge_edge"},
                           kNotPoints[] = {"edge_edge", "vertex_edge", "vertex_face"};

}  // namespace

std::span<const Degeneracy> AllDegeneracies() {
  static constexpr Degeneracy kAll[] = {
      {"edge_angle", "sine of the angle between the edges", kEdges, EdgeAngle},
      {"sliver", "height of the face over its longest edge", kFace, Sliver},
      {"short_edge", "shortest edge over the longest", kNotPoints, ShortEdge},
      {"touching", "distance over the longest edge", kNotPoints, Touching},
      {"tiny", "shortest edge over the distance", kNotPoints, Tiny},
      {"far_foot", "one over the foot point, in edges", kNotPoints, FarFoot},
  };
  return kAll;
}

void DegeneracyCount::Add(double delta, std::uint64_t at) {
  if (delta < kDegenerate) ++count;
  if (delta < smallest || (delta == smallest && index && at < *index)) {
    smallest = delta;
    index = at;
  }
}

void DegeneracyCount::Merge(const DegeneracyCount& other) {
  count += other.count;
  if (other.index &&
      (other.smallest < smallest || (other.smallest == smallest && index && other.index < index))) {
    smallest = other.smallest;
    index = other.index;
  }
}

std::vector<DegeneracyCount> DegeneraciesOf(std::string_view stencil) {
  std::vector<DegeneracyCount> counts;
  for (const Degeneracy& family : AllDegeneracies()) {
    if (std::ranges::find(family.stencils, stencil) != family.stencils.end()) {
      counts.push_back({&family, 0, 1, std::nullopt});
    }
  }
  return counts;
}

}  // namespace definite
