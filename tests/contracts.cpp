#include "tests/contracts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/harness/examine.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite::testing {

namespace {

// Entry (i, j) of a packed matrix of n rows.
double At(const std::vector<double>& a, int n, int i, int j) {
  if (i > j) std::swap(i, j);
  return a[static_cast<std::size_t>(i * n - i * (i - 1) / 2 + j - i)];
}

double Infinite(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

double Scale(const std::vector<double>& f, const std::vector<double>& h) {
  return FrobeniusNorm(f) + FrobeniusNorm(h);
}

// |f - g| against the rounding that a well-written filter of H may show.
double AgainstRounding(const std::vector<double>& f, const std::vector<double>& g,
                       const std::vector<double>& h, int n, double conditioning) {
  const double bound = kRatioBound * n * kUnit / conditioning * Scale(f, h);
  const double distance = FrobeniusDistance(f, g);
  return distance == 0 ? 0 : Infinite(distance / bound);
}

// A rotation of the plane or of space, as a d x d matrix.
struct Rotation {
  std::vector<double> r;
  bool exact;  // entries 0 and +-1: turning a configuration rounds nothing
};

std::vector<Rotation> Rotations(int dimension) {
  if (dimension == 2) return {{{0, -1, 1, 0}, true}, {{0.6, -0.8, 0.8, 0.6}, false}};
  return {{{0, 1, 0, 0, 0, 1, 1, 0, 0}, true},
          {{0, -1, 0, 1, 0, 0, 0, 0, 1}, true},
          {{1, 0, 0, 0, 0, -1, 0, 1, 0}, true},
          {{2. / 3, -1. / 3, 2. / 3, 2. / 3, 2. / 3, -1. / 3, -1. / 3, 2. / 3, 2. / 3}, false}};
}

double ConditioningOf(const EnergyRow& energy, const std::vector<double>& x,
                      const std::vector<double>& p) {
  const auto* reference = reference::FindEnergy<double>(energy.name);
  return reference ? reference->conditioning(x.data(), p.data()) : 1;
}

double RigidMotion(const Subject& s, const Configuration& c, const std::vector<double>& f,
                   const std::vector<double>& h) {
  const EnergyRow& energy = *s.row->energy;
  const int n = energy.dofs, d = energy.dimension;
  double worst = 0;
  for (const Rotation& rotation : Rotations(d)) {
    const auto r = [&](int i, int j) { return rotation.r[static_cast<std::size_t>(i * d + j)]; };
    std::vector<double> turned(c.x.size());
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < d; ++j) {
        turned[static_cast<std::size_t>(i)] +=
            r(i % d, j) * c.x[static_cast<std::size_t>(i / d * d + j)];
      }
    }
    const std::vector<double> g = Outputs(*s.row, turned, c.p);
    std::vector<double> expected;
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) {
        double sum = 0;
        for (int k = 0; k < d; ++k) {
          for (int l = 0; l < d; ++l) {
            sum += r(i % d, k) * At(f, n, i / d * d + k, j / d * d + l) * r(j % d, l);
          }
        }
        expected.push_back(sum);
      }
    }
    // An inexact turn perturbs x by u |x|, which the edges and then the angle between them magnify.
    const double tolerance = rotation.exact ? 1 : 100 / c.conditioning;
    if (rotation.exact || c.well_conditioned) {
      worst = std::max(worst, AgainstRounding(g, expected, h, n, c.conditioning) / tolerance);
    }
  }
  return worst;
}

double Translation(const Configuration& c, const EnergyRow& energy, const std::vector<double>& f,
                   const std::vector<double>& h) {
  const int n = energy.dofs, d = energy.dimension;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < d; ++k) {
      double row = 0;
      for (int j = k; j < n; j += d) row += At(f, n, i, j);
      sum += row * row;
    }
  }
  const double bound = kRatioBound * n * kUnit / c.conditioning * Scale(f, h);
  return sum == 0 ? 0 : Infinite(std::sqrt(sum) / bound);
}

double OtherScales(const Subject& s, const Configuration& c, const std::vector<double>& f,
                   const std::vector<double>& h) {
  double worst = 0;
  for (const double unit : {0x1p-900, 3e-160, 1e-20, 3.0, 1e70, 0x1p900}) {
    Configuration scaled = c;
    for (double& v : scaled.x) v *= unit;
    for (std::size_t i = 0; i < scaled.p.size(); ++i) {
      const int power = s.row->energy->parameters[i].length_power;
      scaled.p[i] *= std::pow(unit, power);
    }
    // A length squared or to the power of four does not go as far as a length.
    const bool representable = std::ranges::equal(c.p, scaled.p, [](double p, double q) {
      return p == 0 || (std::isnormal(q) && std::isfinite(q));
    });
    if (!representable) continue;
    // Rounding the scaled coordinates moves x as an inexact rotation does.
    const bool exact = std::frexp(unit, std::array<int, 1>().data()) == 0.5;
    if (!exact && !c.well_conditioned) continue;
    const double tolerance = exact ? 1 : 100 / c.conditioning;
    worst = std::max(worst, AgainstRounding(Outputs(*s.row, scaled.x, scaled.p), f, h,
                                            s.row->energy->dofs, c.conditioning) /
                                tolerance);
  }
  return worst;
}

double Relabelled(const Subject& s, const Configuration& c, const std::vector<double>& f,
                  const std::vector<double>& h) {
  const EnergyRow& energy = *s.row->energy;
  const int n = energy.dofs, d = energy.dimension;
  const auto vertices = static_cast<std::size_t>(n / d);
  double worst = 0;
  for (std::size_t first = 0; first < energy.relabellings.size(); first += vertices) {
    const auto old = [&](int i) {
      return energy.relabellings[first + static_cast<std::size_t>(i / d)] * d + i % d;
    };
    std::vector<double> x(c.x.size()), expected;
    for (int i = 0; i < n; ++i) {
      x[static_cast<std::size_t>(i)] = c.x[static_cast<std::size_t>(old(i))];
    }
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) expected.push_back(At(f, n, old(i), old(j)));
    }
    // The frame starts at another edge now, whose angle may be far worse.
    const double conditioning = std::min(c.conditioning, ConditioningOf(energy, x, c.p));
    if (conditioning < 1e-7) continue;
    worst =
        std::max(worst, AgainstRounding(Outputs(*s.row, x, c.p), expected, h, n, conditioning) / 2);
  }
  return worst;
}

double OffScalar(const Subject& s, const Configuration& c, const std::vector<double>& f) {
  if (s.row->lanes == 1) return 0;
  if (!s.scalar) return std::numeric_limits<double>::infinity();
  // Every lane of a tile, each with another configuration beside it.
  const auto lanes = static_cast<std::size_t>(s.row->lanes);
  const auto tile = [&](const std::vector<double>& numbers, bool vary) {
    std::vector<double> tiled;
    for (double v : numbers) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        tiled.push_back(vary ? v * static_cast<double>(1 + lane) : v);
      }
    }
    return tiled;
  };
  const std::vector<double> x = tile(c.x, true), p = tile(c.p, false);
  std::vector<double> out(f.size() * lanes);
  s.row->run(x.data(), p.data(), out.data(), 1);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    std::vector<double> one;
    for (double v : c.x) one.push_back(v * static_cast<double>(1 + lane));
    const std::vector<double> expected = Outputs(*s.scalar, one, c.p);
    for (std::size_t k = 0; k < f.size(); ++k) {
      const double a = out[k * lanes + lane], b = expected[k];
      if (std::bit_cast<std::uint64_t>(a) != std::bit_cast<std::uint64_t>(b) &&
          !(std::isnan(a) && std::isnan(b))) {
        return std::numeric_limits<double>::infinity();
      }
    }
  }
  return 0;
}

// What the distributions leave at its default: two of three configurations get another stiffness
// and a side of their own, if the energy is defined on it; each has one of five thresholds.
void VaryParameters(const EnergyRow& energy, int i, Configuration& c) {
  const double stiffness[] = {1, 3.5, 0.3}, side[] = {0, 1, -1};
  const double threshold[] = {1, 0.1, 10, 100, 1e-9};
  const auto* reference = reference::FindEnergy<double>(energy.name);
  std::vector<double>& p = c.p;
  for (std::size_t j = 0; j < p.size(); ++j) {
    const std::string_view name = energy.parameters[j].name;
    if (name == "k" || name == "mu") p[j] = stiffness[i % 3];
    if (name == "ex") p[j] = threshold[i % 5];
    if (name == "side") {
      p[j] = side[i % 3];
      if (!reference->in_domain(c.x.data(), p.data())) p[j] = 0;
    }
  }
}

// Vertex over a triangle: the vertex at foot point beta e0 + gamma e1 and height l.
Configuration VertexFaceCase(std::string name, std::vector<double> e0, std::vector<double> e1,
                             double beta, double gamma, double l, double eps, double shift) {
  const std::vector<double> c = {e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                                 e0[0] * e1[1] - e0[1] * e1[0]};
  const double area = std::hypot(c[0], c[1], c[2]);
  Configuration r{std::move(name), {}, {1, eps, 0}, false, 1};
  r.x.resize(12);
  for (std::size_t i = 0; i < 3; ++i) {
    r.x[i] = shift + beta * e0[i] + gamma * e1[i] + l * c[i] / area;
    r.x[3 + i] = shift + e0[i];
    r.x[6 + i] = shift;
    r.x[9 + i] = shift + e1[i];
  }
  return r;
}

std::vector<Configuration> DegenerateVertexFaces() {
  const std::vector<double> ex = {1, 0, 0}, ey = {0, 1, 0}, e0 = {0.9, 0.2, -0.4},
                            e1 = {-0.3, 0.8, 0.5};
  std::vector<Configuration> cases = {
      VertexFaceCase("l = 0 exactly", ex, ey, 0.25, 0.5, 0, 0.1, 0),
      VertexFaceCase("l = 0 after rounding", e0, e1, 0.3, 0.4, 0, 0.1, 0),
      VertexFaceCase("l = 1e-12", ex, ey, 0.25, 0.5, 1e-12, 0.1, 0),
      VertexFaceCase("l = -1e-16", e0, e1, 0.25, 0.5, -1e-16, 0.1, 0),
      VertexFaceCase("l = eps - 1e-15", ex, ey, 0.25, 0.5, 0.1 - 1e-15, 0.1, 0),
      VertexFaceCase("vertex on a triangle vertex", ex, ey, 0, 0, 0, 0.1, 0),
      VertexFaceCase("height 1e-4", ex, {0.5, 1e-4, 0}, 0.3, 0.3, 0.05, 0.1, 0),
      VertexFaceCase("height 1e-7", ex, {0.5, 1e-7, 0}, 0.3, 0.3, 0.05, 0.1, 0),
      VertexFaceCase("height 1e8", ex, {0.5, 1e8, 0}, 0.3, 0.3, 0.05, 0.1, 0),
      VertexFaceCase("deep under a tiny triangle", {1e-6, 0, 0}, {0, 1e-6, 0}, 0.3, 0.3, -1, 0.1,
                     0),
      VertexFaceCase("equilateral, over the centroid", ex, {0.5, std::sqrt(0.75), 0}, 1. / 3,
                     1. / 3, 0.05, 0.1, 0),
      VertexFaceCase("equilateral, deep under the centroid", ex, {0.5, std::sqrt(0.75), 0}, 1. / 3,
                     1. / 3, -1e3, 0.1, 0),
      VertexFaceCase("foot point far outside", ex, ey, 100, -50, 0.05, 0.1, 0),
      VertexFaceCase("far from the origin", ex, ey, 0.25, 0.5, 0.0625, 0.125, 0x1p20),
      VertexFaceCase("side flipped", e0, e1, 0.3, 0.4, -0.05, 0.1, 0),
  };
  cases.back().p[2] = -1;
  return cases;
}

// Two edges, the closest points at a and b along them and l between these.
Configuration CrossingCase(std::string name, std::vector<double> e0, std::vector<double> e1,
                           double a, double b, double l, double eps) {
  const std::vector<double> c = {e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                                 e0[0] * e1[1] - e0[1] * e1[0]};
  const double area = std::hypot(c[0], c[1], c[2]);
  Configuration r{std::move(name), {}, {1, eps, 0}, false, 1};
  r.x.resize(12);
  for (std::size_t i = 0; i < 3; ++i) {
    r.x[i] = -a * e0[i];
    r.x[3 + i] = (1 - a) * e0[i];
    r.x[6 + i] = l * c[i] / area - b * e1[i];
    r.x[9 + i] = l * c[i] / area + (1 - b) * e1[i];
  }
  return r;
}

std::vector<Configuration> CrossingEdges() {
  const std::vector<double> ex = {1, 0, 0}, ey = {0, 1, 0}, e0 = {0.9, 0.2, -0.4},
                            e1 = {-0.3, 0.8, 0.5};
  return {
      CrossingCase("l = 0 exactly", ex, ey, 0.25, 0.5, 0, 0.1),
      CrossingCase("l = 1e-12", e0, e1, 0.25, 0.5, 1e-12, 0.1),
      CrossingCase("midpoints of equal edges at a right angle", ex, ey, 0.5, 0.5, 0.05, 0.1),
      CrossingCase("midpoints, deep", ex, ey, 0.5, 0.5, -1e3, 0.1),
      CrossingCase("one edge tiny, deep", ex, {0, 1e-6, 0}, 0.3, 0.4, -1, 0.1),
      CrossingCase("angle 1e-4", ex, {1, 1e-4, 0}, 0.3, 0.6, 0.05, 0.1),
      CrossingCase("angle 1e-7", ex, {1, 1e-7, 0}, 0.5, 0.5, 0.05, 0.1),
      CrossingCase("end of one edge", ex, ey, -0.02, 0.5, 0.05, 0.1),
      CrossingCase("ends of both", e0, e1, 1.02, -0.03, 0.05, 0.1),
  };
}

// Two edges e0 and e1, x2 - x0 = e2.
Configuration ParallelCase(std::string name, std::vector<double> e0, std::vector<double> e1,
                           std::vector<double> e2, double side, double ex) {
  Configuration r{std::move(name), {}, {1, 0.1, side, ex}, false, 1};
  r.x.resize(12);
  for (std::size_t i = 0; i < 3; ++i) {
    r.x[3 + i] = e0[i];
    r.x[6 + i] = e2[i];
    r.x[9 + i] = e2[i] + e1[i];
  }
  return r;
}

// Edges that are parallel or nearly so, and at the threshold, for energies that have one.
std::vector<Configuration> ParallelEdges() {
  const std::vector<double> ex = {1, 0, 0}, ey = {0, 1, 0}, e0 = {0.875, 0.25, -0.375},
                            half = {0.4375, 0.125, -0.1875}, back = {-1.75, -0.5, 0.75};
  std::vector<Configuration> cases = {
      ParallelCase("parallel", ex, ex, {0.25, 0, 0.05}, 1, 1),
      ParallelCase("parallel, inside each other", ex, ex, {0.25, 0, 0.05}, -1, 1),
      ParallelCase("parallel, head to tail", ex, ex, {1.03, 0.02, 0.05}, 1, 1),
      ParallelCase("parallel, askew and shorter", e0, half, {0.25, 0.1, -0.05}, 1, 0.3),
      ParallelCase("antiparallel, askew and longer", e0, back, {1.1, 0.25, -0.45}, 1, 20),
      ParallelCase("parallel, nearly touching", ex, ex, {0.25, 0, 1e-6}, 1, 1),
      ParallelCase("parallel, the threshold tiny", ex, ex, {0.25, 0, 0.05}, 1, 1e-30),
      ParallelCase("parallel, the threshold huge", ex, ex, {0.25, 0, 0.05}, 1, 1e30),
      ParallelCase("parallel, one edge 1e-6", {1e-6, 0, 0}, ex, {-0.25, 0, 0.05}, 1, 1),
      ParallelCase("parallel, the other 1e-6", ex, {-1e-6, 0, 0}, {0.25, 0, 0.05}, 1, 1e-12),
      ParallelCase("c = ex", ex, ey, {0.25, -0.5, 0.05}, 1, 1),
      ParallelCase("c below ex by a roundoff", ex, ey, {0.25, -0.5, 0.05}, 1, 1 + 0x1p-52),
      ParallelCase("c = ex at an end", ex, ey, {0.25, 0.03, 0.05}, 1, 1),
  };
  for (const double angle :
       {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14}) {
    const std::string at = "angle " + std::to_string(std::log10(angle));
    // Crossing in the middle, where the sine is large enough.
    if (angle > 1e-8) {
      cases.push_back(
          ParallelCase(at + ", crossing", ex, {1, angle, 0}, {0, -angle / 2, 0.05}, 1, 1));
    }
    // Nearest at the start of one, clearly: of parallel edges no point is nearer than another.
    cases.push_back(ParallelCase(at + ", rising", ex, {1, angle, angle}, {0.25, 0, 0.05}, 1, 1));
    cases.push_back(ParallelCase(at + ", apart", ex, {1, -angle, angle}, {1.03, 0.02, 0.05}, 1, 1));
    cases.push_back(ParallelCase(at + ", half the threshold", ex, {1, angle, angle},
                                 {0.25, 0, 0.05}, 1, 4 * angle * angle));
  }
  return cases;
}

}  // namespace

std::vector<double> Outputs(const KernelRow& row, const std::vector<double>& x,
                            const std::vector<double>& p) {
  std::vector<double> out(static_cast<std::size_t>(row.outputs));
  RunOne(row, x.data(), p.data(), out.data());
  return out;
}

std::vector<double> AccuracyViolations(std::span<const KernelRow* const> rows,
                                       const Configuration& c) {
  Examiner examiner(*rows[0]->energy, rows);
  examiner.Examine(c.x.data(), c.p.data(), Depth::kTruth);
  std::vector<double> violations(rows.size(), 0);
  if (!examiner.Configuration().active) return violations;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto rounding = examiner.Row(r).conditioned_rounding;
    violations[r] =
        rounding ? Infinite(*rounding / kRatioBound) : std::numeric_limits<double>::infinity();
  }
  return violations;
}

double Violation(Property property, const Subject& s, const Configuration& c) {
  const int n = s.row->energy->dofs;
  const std::vector<double> f = Outputs(*s.row, c.x, c.p), h = Outputs(*s.exact, c.x, c.p);
  const double bound = kRatioBound * n * kUnit;
  switch (property) {
    case Property::kFinite:
      return AllFinite(f) ? 0 : std::numeric_limits<double>::infinity();
    case Property::kPsd: {
      const double norm = FrobeniusNorm(f);
      return norm == 0 ? 0 : Infinite(-Eigenvalues(f).front() / (bound * norm));
    }
    case Property::kAccurate:
      return AccuracyViolations({&s.row, 1}, c)[0];
    case Property::kLanesEqualScalar:
      return OffScalar(s, c, f);
    case Property::kKeepsPsd:
      return Eigenvalues(h).front() < -bound * FrobeniusNorm(h)
                 ? 0
                 : AgainstRounding(f, h, h, n, c.conditioning);
    case Property::kMajorises: {
      const double shortfall = -Eigenvalues(Difference(f, h)).front();
      if (shortfall == 0) return 0;
      return Infinite(shortfall / (bound / c.conditioning * Scale(f, h)));
    }
    case Property::kRigidMotion:
      return RigidMotion(s, c, f, h);
    case Property::kTranslation:
      return Translation(c, *s.row->energy, f, h);
    case Property::kScale:
      return OtherScales(s, c, f, h);
    case Property::kRelabelling:
      return Relabelled(s, c, f, h);
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<Configuration> Configurations(const EnergyRow& energy) {
  constexpr int kDrawn = 40;
  constexpr std::uint64_t kSeed = 20230801;
  std::vector<Configuration> all;
  for (const Distribution& distribution : AllDistributions()) {
    if (!distribution.supports(energy.stencil)) continue;
    Batch batch(energy);
    batch.Draw(distribution, kSeed, 0, kDrawn);
    for (int i = 0; i < kDrawn; ++i) {
      Configuration c{std::string(distribution.name) + " " + std::to_string(i), {}, {}, false, 1};
      c.x.assign(batch.X(i), batch.X(i) + energy.dofs);
      c.p.assign(batch.P(i), batch.P(i) + energy.parameters.size());
      VaryParameters(energy, i, c);
      all.push_back(c);
    }
  }
  for (Configuration& c : all) {
    const auto* reference = reference::FindEnergy<double>(energy.name);
    const double length =
        reference && reference->length ? reference->length(c.x.data(), c.p.data()) : 1;
    c.conditioning = ConditioningOf(energy, c.x, c.p);
    c.well_conditioned = c.conditioning > 0.1 && std::abs(length) > 0.01;
  }
  std::vector<Configuration> degenerate;
  if (energy.stencil == "vertex_face") degenerate = DegenerateVertexFaces();
  if (energy.stencil == "edge_edge") degenerate = CrossingEdges();
  if (std::ranges::find(energy.parameters, "ex", &Parameter::name) != energy.parameters.end()) {
    for (const Configuration& c : ParallelEdges()) degenerate.push_back(c);
  }
  for (Configuration& c : degenerate) {
    for (std::size_t j = c.p.size(); j < energy.parameters.size(); ++j) {
      c.p.push_back(energy.parameters[j].value);
    }
    c.conditioning = ConditioningOf(energy, c.x, c.p);
    all.push_back(c);
  }
  return all;
}

}  // namespace definite::testing
