#include "fuzz/family.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "benchmarks/harness/sampling/simplex.hpp"

namespace definite::fuzz {

namespace {

using Point = std::array<double, 3>;

// 2^f for f in [0,1], in + and * alone: the same bits everywhere. Good to three digits, which is
// enough for a distribution.
double ShortPower(double f) { return 1 + f * (0.6931 + f * (0.2402 + f * (0.0555 + f * 0.0112))); }

// With twelve significant bits.
double Short(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const int exponent = std::ilogb(value);
  return std::ldexp(std::nearbyint(std::ldexp(value, 11 - exponent)), exponent - 11);
}

Point Plus(const Point& p, double s, const Point& q) {
  return {p[0] + s * q[0], p[1] + s * q[1], p[2] + s * q[2]};
}

// By the quaternion of four numbers, which need not be a unit.
Point Turned(const Point& p, const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  const double s = 2 / (w * w + x * x + y * y + z * z);
  return {p[0] - s * ((y * y + z * z) * p[0] - (x * y - w * z) * p[1] - (x * z + w * y) * p[2]),
          p[1] - s * ((x * x + z * z) * p[1] - (x * y + w * z) * p[0] - (y * z - w * x) * p[2]),
          p[2] - s * ((x * x + y * y) * p[2] - (x * z - w * y) * p[0] - (y * z + w * x) * p[1])};
}

// The vertices of a pair or a strand, in a plane of their own.
std::array<Point, 4> Vertices(const Shape& s, std::string_view stencil) {
  const double cosine = std::sqrt(1 - s.sine * s.sine);
  const Point e0 = {s.length0, 0, 0},
              e1 = {(s.obtuse ? -cosine : cosine) * s.length1, s.sine * s.length1, 0},
              n = {0, 0, s.l}, origin = {0, 0, 0};
  if (stencil == "vertex_face") return {Plus(Plus(n, s.a, e0), s.b, e1), e0, origin, e1};
  if (stencil == "edge_edge") {
    const Point e2 = Plus(Plus(n, s.a, e0), -s.b, e1);
    return {origin, e0, e2, Plus(e2, 1, e1)};
  }
  if (stencil == "vertex_edge") return {Plus(n, s.a, e0), origin, e0, origin};
  if (stencil == "vertex_vertex") return {origin, n, origin, origin};
  if (stencil == "segment") return {origin, e0, origin, origin};
  if (stencil == "torsion") {
    const double t = s.half_twist, inverse = 1 / (1 + t * t);
    const Point turned = {e1[0], e1[1] * (1 - t * t) * inverse, e1[1] * (2 * t) * inverse};
    return {e1, origin, e0, Plus(e0, 1, turned)};
  }
  return {e0, origin, e1, origin};
}

Shape InShort(const Shape& s) {
  Shape shape = s;
  for (double* value : {&shape.length0, &shape.length1, &shape.sine, &shape.a, &shape.b, &shape.l,
                        &shape.eps, &shape.half_twist, &shape.unit, &shape.rest_height}) {
    *value = Short(*value);
  }
  for (double& stretch : shape.stretches) stretch = Short(stretch);
  return shape;
}

// The edges of the rest shape, in columns: a corner whose later edges lean towards the first, and
// whose last vertex may be close to the others.
Matrix3 RestEdges(const Shape& s, const Genes& genes, std::size_t dimension) {
  Matrix3 rest = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (genes.pose != Genes::kAxes) {
    rest[0][1] = Short(genes.u[3] - 0.5);
    if (dimension == 3) {
      rest[0][2] = Short(genes.u[4] - 0.5);
      rest[1][2] = Short(genes.u[5] - 0.5);
    }
  }
  rest[dimension - 1][dimension - 1] = s.rest_height;
  return rest;
}

// Of an upper triangular matrix.
Matrix3 Inverse(const Matrix3& a) {
  Matrix3 r{};
  for (std::size_t i = 3; i-- > 0;) {
    r[i][i] = 1 / a[i][i];
    for (std::size_t j = i + 1; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = i + 1; k <= j; ++k) sum += a[i][k] * r[k][j];
      r[i][j] = -sum / a[i][i];
    }
  }
  return r;
}

// Half of all configurations leave the side to the sign of l.
double SideOf(const Genes& genes) {
  const int quarter = static_cast<int>(16 * genes.u[6]) % 4;
  return quarter == 2 ? 1 : quarter == 3 ? -1 : 0;
}

// What a parameter is in edges of length 1.
double OfShape(const Shape& shape, const Genes& genes, const DrawTarget& target,
               const Parameter& parameter) {
  if (parameter.name == "eps") return shape.eps;
  if (parameter.name == "side") return SideOf(genes);
  if (parameter.name == "tau0") return genes.u[6] < 0.5 ? -parameter.value : parameter.value;
  if (parameter.name.starts_with("rest_")) {
    const auto digit = [&](std::size_t i) {
      return static_cast<std::size_t>(parameter.name[i] - '0');
    };
    const Matrix3 inverse = Inverse(RestEdges(shape, genes, DimensionOf(target.stencil)));
    return inverse[digit(5)][digit(6)];
  }
  return parameter.value;
}

// The parameters in a unit of length; false if one that is more than a length cannot be said in it.
bool ParametersIn(double unit, const Shape& shape, const Genes& genes, const DrawTarget& target,
                  double* p) {
  bool said = true;
  for (const Parameter& parameter : target.parameters) {
    double power = 1;
    for (int k = 0; k < std::abs(parameter.length_power); ++k) power *= unit;
    if (parameter.length_power < 0) power = 1 / power;
    *p = OfShape(shape, genes, target, parameter) * power;
    const bool is_zero = parameter.length_power < 0 && *p == 0;
    const bool is_length = parameter.length_power == 0 || parameter.length_power == 1;
    if (!is_length && !is_zero && !std::isnormal(*p)) said = false;
    ++p;
  }
  return said;
}

// F times the rest shape, F = U diag(stretches) V^T; but for turned ones along the axes.
// Coordinates are not rounded further: of a sliver little would be left of F.
void PoseSimplex(const Shape& shape, const Genes& genes, std::size_t dimension, double unit,
                 double* x) {
  const auto turn = [&](std::size_t first) {
    std::array<double, 4> q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = NormalQuantile(genes.u[first + i]);
    return TurnOf(q, dimension);
  };
  Matrix3 f{};
  for (std::size_t i = 0; i < dimension; ++i) {
    f[i][i] = shape.stretches[i + 1 < dimension ? i : 2];
  }
  if (genes.pose == Genes::kTurned) f = Product(Product(turn(8), f), turn(4));
  std::array<double, 12> vertices;
  PutVertices(Product(f, RestEdges(shape, genes, dimension)), dimension, vertices.data());
  for (std::size_t i = 0; i < dimension * (dimension + 1); ++i) {
    *x++ = (vertices[i] + shape.shift[i % dimension]) * unit;
  }
}

Distribution DistributionOf(const Family& family, std::optional<int> decade,
                            const std::string& name) {
  return {name, std::string(family.meaning),
          [&family](std::string_view stencil) { return family.Has(stencil); },
          [&family, decade](const DrawTarget& target, std::uint64_t seed, std::uint64_t index,
                            double* x, double* p) {
            Make(family, GenesAt(family, decade, seed, index), target, x, p);
          }};
}

}  // namespace

Genes DrawGenes(Draws& draws, std::optional<int> decade) {
  constexpr double kOctaves = 53.15;  // in sixteen decades
  Genes genes;
  const double t = draws.OpenUniform(), zero = draws.OpenUniform();
  const double decades = decade ? *decade + t : 16 * t;
  const double octaves = decades / 16 * kOctaves, whole = std::floor(octaves);
  genes.delta = std::ldexp(1 / ShortPower(octaves - whole), -static_cast<int>(whole));
  if (decade ? *decade == kDecades - 1 : zero < 1. / kDecades) genes.delta = 0;
  genes.negative = draws.OpenUniform() < 0.5;
  const double pose = draws.OpenUniform();
  genes.pose = pose < 0.25 ? Genes::kAxes : pose < 0.5 ? Genes::kDyadic : Genes::kTurned;
  for (double& u : genes.u) u = draws.OpenUniform();
  return genes;
}

Genes GenesAt(const Family& family, std::optional<int> decade, std::uint64_t seed,
              std::uint64_t index) {
  Draws draws(StreamId(family.name), seed, index);
  return DrawGenes(draws, decade);
}

Shape OrdinaryShape(const Genes& genes) {
  const auto& u = genes.u;
  Shape shape;
  shape.length0 = 0.5 + 1.5 * u[0];
  shape.length1 = 0.5 + 1.5 * u[1];
  shape.sine = 0.5 + 0.5 * u[2];
  shape.obtuse = u[3] < 0.5;
  shape.a = u[4];
  shape.b = u[5];
  if (shape.a + shape.b > 1) {  // inside a face, which no pair of edges minds
    shape.a = 1 - shape.a;
    shape.b = 1 - shape.b;
  }
  shape.eps = 0.05 + 0.2 * u[6];
  shape.l = (2 * u[7] - 1) * shape.eps;
  shape.half_twist = 3 * (2 * u[7] - 1);
  shape.unit = 1;
  shape.shift = {};
  shape.stretches = {1 + u[0], 0.75 + 0.5 * u[1], 0.5 + 0.5 * u[2]};
  shape.rest_height = 1;
  return shape;
}

void Pose(const Shape& given, const Genes& genes, const DrawTarget& target, double* x, double* p) {
  const Shape shape = genes.pose == Genes::kDyadic ? InShort(given) : given;
  // Where a parameter cannot be said in such units, the configuration stays in its own.
  const double unit = ParametersIn(shape.unit, shape, genes, target, p) ? shape.unit : 1;
  if (unit != shape.unit) ParametersIn(unit, shape, genes, target, p);
  if (IsSimplex(target.stencil)) {
    return PoseSimplex(shape, genes, DimensionOf(target.stencil), unit, x);
  }
  const auto& u = genes.u;
  const std::array<double, 4> turn = {NormalQuantile(u[8]), NormalQuantile(u[9]),
                                      NormalQuantile(u[10]), NormalQuantile(u[11])};
  const std::array<Point, 4> vertices = Vertices(shape, target.stencil);
  for (int v = 0; v < target.dofs / 3; ++v) {
    Point at = vertices[static_cast<std::size_t>(v)];
    if (genes.pose == Genes::kTurned) at = Turned(at, turn);
    at = Plus(at, 1, shape.shift);
    for (const double coordinate : at) *x++ = coordinate * unit;
  }
}

bool Family::Has(std::string_view stencil) const {
  return std::ranges::find(stencils, stencil) != stencils.end();
}

void Make(const Family& family, const Genes& genes, const DrawTarget& target, double* x,
          double* p) {
  Shape shape = OrdinaryShape(genes);
  family.deform(genes, shape);
  Pose(shape, genes, target, x, p);
}

const Distribution* FindFamily(std::string_view name) {
  constexpr std::string_view kPrefix = "fuzz/";
  if (!name.starts_with(kPrefix)) return nullptr;
  std::string_view rest = name.substr(kPrefix.size());
  std::optional<int> decade;
  if (const std::size_t slash = rest.find('/'); slash != rest.npos) {
    const std::string_view text = rest.substr(slash + 1);
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 ||
        value >= kDecades) {
      return nullptr;
    }
    decade = value;
    rest = rest.substr(0, slash);
  }
  const auto family = std::ranges::find(AllFamilies(), rest, &Family::name);
  if (family == AllFamilies().end()) return nullptr;
  static std::map<std::string, Distribution, std::less<>> made;
  const auto at = made.find(name);
  if (at != made.end()) return &at->second;
  const std::string key(name);
  return &made.emplace(key, DistributionOf(*family, decade, key)).first->second;
}

}  // namespace definite::fuzz
