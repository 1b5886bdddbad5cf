// Meshes, problems and the solver of definite newton.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <set>

#include "benchmarks/harness/sampling/random.hpp"
#include "benchmarks/newton/catalogue.hpp"
#include "benchmarks/newton/cut.hpp"
#include "benchmarks/newton/layout.hpp"
#include "benchmarks/newton/obj.hpp"
#include "benchmarks/newton/objective.hpp"
#include "benchmarks/newton/report.hpp"
#include "benchmarks/newton/shapes.hpp"
#include "benchmarks/newton/step_limit.hpp"
#include "benchmarks/newton/study.hpp"

namespace definite::newton {
namespace {

const EnergyRow& EnergyNamed(const std::string& name) {
  return *std::ranges::find(AllEnergies(), "distortion/" + name, &EnergyRow::name);
}

Problem ProblemNamed(std::string_view name, const std::string& energy, std::uint64_t seed = 1) {
  const Template& of = *std::ranges::find(AllProblems(), name, &Template::name);
  return of.make(of, EnergyNamed(std::string(of.stencil) + "/" + energy), true, seed);
}

Descent SolveBy(const Problem& problem, std::string_view filter, const Settings& settings = {}) {
  return Solve(problem, *RowOf(*problem.energy, filter), settings);
}

std::vector<const EnergyRow*> DistortionEnergies() {
  std::vector<const EnergyRow*> energies;
  for (const EnergyRow& energy : AllEnergies()) {
    if (energy.name.starts_with("distortion/")) energies.push_back(&energy);
  }
  return energies;
}

Mesh FlatDisk(int rings) { return MakeDisk(rings, Cone(0)); }

// A closed surface: faces of a cube, each cut into n x n squares, on the unit sphere.
Mesh Sphere(int n) {
  Mesh mesh;
  std::vector<std::pair<std::array<int, 3>, int>> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    for (const auto& [place, number] : known) {
      if (place == at) return number;
    }
    const Point p = {2.0 * at[0] / n - 1, 2.0 * at[1] / n - 1, 2.0 * at[2] / n - 1};
    mesh.rest.push_back((1 / Norm(p)) * p);
    known.emplace_back(at, mesh.Vertices() - 1);
    return mesh.Vertices() - 1;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return vertex(at);
          };
          int quad[] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (side == 0) std::swap(quad[1], quad[3]);
          mesh.elements.insert(mesh.elements.end(),
                               {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
        }
      }
    }
  }
  return mesh;
}

Mesh Torus(int n) {
  Mesh mesh;
  const auto angle = [n](int i) { return 2 * std::numbers::pi * i / n; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double radius = 2 + std::cos(angle(j));
      mesh.rest.push_back(
          {radius * std::cos(angle(i)), radius * std::sin(angle(i)), std::sin(angle(j))});
    }
  }
  const auto vertex = [n](int i, int j) { return i % n * n + j % n; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                d = vertex(i, j + 1);
      mesh.elements.insert(mesh.elements.end(), {a, b, c, a, c, d});
    }
  }
  return mesh;
}

// The disk without its middle.
Mesh Annulus() {
  Mesh annulus = FlatDisk(4);
  annulus.elements.erase(annulus.elements.begin(), annulus.elements.begin() + 3 * 24);
  return annulus;
}

// Two tori joined where a triangle of each was.
Mesh DoubleTorus(int n) {
  Mesh mesh = Torus(n);
  const Mesh other = Torus(n);
  const int first[] = {mesh.elements[0], mesh.elements[1], mesh.elements[2]};
  mesh.elements.erase(mesh.elements.begin(), mesh.elements.begin() + 3);
  for (std::size_t i = 3; i < other.elements.size(); ++i) {
    const int v = other.elements[i];
    // Turned over: its triangle is met from the other side.
    const int twin[] = {first[0], first[2], first[1]};
    const auto at = std::ranges::find(first, v) - first;
    mesh.elements.push_back(at < 3 ? twin[at] : v + other.Vertices());
  }
  for (const Point& p : other.rest) mesh.rest.push_back({8 - p[0], p[1], p[2]});
  return mesh;
}

double AreaOf(const Mesh& mesh) {
  double sum = 0;
  for (int e = 0; e < mesh.Elements(); ++e) sum += MeasureOf(mesh, e);
  return sum;
}

TEST(Shapes, AreDisks) {
  for (const int rings : {1, 2, 5}) {
    const Mesh disk = FlatDisk(rings);
    EXPECT_EQ(disk.Vertices(), 1 + 3 * rings * (rings + 1));
    EXPECT_EQ(disk.Elements(), 6 * rings * rings);
    EXPECT_EQ(EulerCharacteristic(disk), 1);
    const auto boundaries = BoundariesOf(disk);
    ASSERT_EQ(boundaries.size(), 1u);
    EXPECT_EQ(boundaries.front().size(), static_cast<std::size_t>(6 * rings));
  }
  // Of a regular polygon with 6 * 20 corners.
  EXPECT_NEAR(AreaOf(FlatDisk(20)), 60 * std::sin(std::numbers::pi / 60), 1e-12);
  // A sphere's cap: 2 pi (1 - cos).
  EXPECT_NEAR(AreaOf(MakeDisk(40, Cap(2))), 2 * std::numbers::pi * (1 - std::cos(2)), 0.01);
}

// That a plane shape has an isometric layout.
TEST(Shapes, PlaneOnesAreNotFolded) {
  for (const int rings : {6, 24}) {
    const Mesh star = MakeDisk(rings, Star(0.4, 3));
    for (int e = 0; e < star.Elements(); ++e) {
      const int* const v = star.Element(e);
      EXPECT_GT(Cross(star.At(v[1]) - star.At(v[0]), star.At(v[2]) - star.At(v[0]))[2], 0) << e;
    }
  }
}

TEST(Shapes, BlocksAreFilledWithTetrahedra) {
  const Mesh block = MakeBlock(2, 3, 4);
  EXPECT_EQ(block.Vertices(), 3 * 4 * 5);
  EXPECT_EQ(block.Elements(), 6 * 24);
  EXPECT_EQ(EulerCharacteristic(block), 1);
  for (int e = 0; e < block.Elements(); ++e) EXPECT_NEAR(MeasureOf(block, e), 1.0 / 6, 1e-15);
}

TEST(Topology, CountsTheHandles) {
  EXPECT_EQ(EulerCharacteristic(Sphere(3)), 2);
  EXPECT_EQ(EulerCharacteristic(Torus(5)), 0);
  EXPECT_TRUE(BoundariesOf(Torus(5)).empty());
}

TEST(Cut, OpensAnySurface) {
  Mesh holed = Torus(6);
  holed.elements.erase(holed.elements.begin(), holed.elements.begin() + 3);
  for (const Mesh& mesh :
       {Sphere(1), Sphere(2), Sphere(6), Torus(4), Torus(9), Annulus(), holed, DoubleTorus(7)}) {
    const Mesh disk = MakeDiskOf(mesh);
    EXPECT_EQ(disk.Elements(), mesh.Elements());
    EXPECT_EQ(EulerCharacteristic(disk), 1);
    EXPECT_EQ(BoundariesOf(disk).size(), 1u);
    EXPECT_EQ(AreaOf(disk), AreaOf(mesh));
    EXPECT_NO_THROW(EmbedDisk(disk));
  }
}

TEST(Cut, IsShortWhereItCanBe) {
  // From one boundary straight to the other: both have one vertex more.
  const Mesh annulus = Annulus(), disk = MakeDiskOf(annulus);
  const std::set<int> used(annulus.elements.begin(), annulus.elements.end());
  EXPECT_EQ(disk.rest.size(), used.size() + 3);
  // A tree of shortest paths has no more: 33 edges, twice.
  EXPECT_LE(BoundariesOf(MakeDiskOf(Sphere(6))).front().size(), 66u);
}

TEST(Cut, LeavesADiskAsItIs) {
  const Mesh disk = MakeDisk(3, Cap(1));
  const Mesh same = MakeDiskOf(disk);
  EXPECT_EQ(same.Vertices(), disk.Vertices());
  EXPECT_EQ(AreaOf(same), AreaOf(disk));
}

std::string RefusalOf(const Mesh& mesh) {
  try {
    MakeDiskOf(mesh);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "";
}

TEST(Cut, RefusesWhatIsNoSurface) {
  Mesh two = FlatDisk(1);
  for (const int v : FlatDisk(1).elements) two.elements.push_back(v + 7);
  for (const Point& p : FlatDisk(1).rest) two.rest.push_back(p);
  EXPECT_EQ(RefusalOf(two), "expected one surface, found 2 parts");
  // A fan whose first and last triangles meet in a vertex alone.
  Mesh pinched = FlatDisk(2);
  for (int& v : pinched.elements) v = v == 13 ? 7 : v;
  EXPECT_NE(RefusalOf(pinched), "");
  Mesh fin = FlatDisk(1);
  fin.rest.push_back({0, 0, 1});
  fin.elements.insert(fin.elements.end(), {0, 1, 7});
  EXPECT_EQ(RefusalOf(fin),
            "triangle 7 at the edge of vertices 1 and 2: expected two triangles there, found a "
            "third");
  Mesh turned = FlatDisk(1);
  std::swap(turned.elements[0], turned.elements[1]);
  EXPECT_NE(RefusalOf(turned).find("expected it to be turned as its neighbour is"),
            std::string::npos);
}

class Obj : public ::testing::Test {
 protected:
  static Mesh Read(const std::string& text) {
    const std::string path = ::testing::TempDir() + "newton_test.obj";
    std::ofstream(path) << text;
    return ReadObj(path);
  }
  static std::string Refusal(const std::string& text) {
    try {
      Read(text);
    } catch (const MeshError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Obj, IsReadInAllItsForms) {
  const Mesh mesh = Read(
      "# a square and a triangle\nmtllib none\nv 0 0 0\nv 1 0 0 1.0\nvn 0 0 1\nv 1 1 0\nv 0 1e0 0\n"
      "f 1/1 2/2/3 3//1 4 # fan\nv 0.5 2 -0.5\nf -1 -2 -3\n");
  EXPECT_EQ(mesh.elements, (std::vector<int>{0, 1, 2, 0, 2, 3, 4, 3, 2}));
  EXPECT_EQ(mesh.rest[4], (Point{0.5, 2, -0.5}));
}

TEST_F(Obj, IsRefusedWithItsLine) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_EQ(Refusal("v 0 0\n"), "line 1: expected three coordinates, found 2");
  EXPECT_EQ(Refusal("\nv 0 0 x\n"), "line 2: 'x': expected a coordinate");
  EXPECT_EQ(Refusal("v 0 0 inf\n"), "line 1: 'inf': expected a coordinate");
  EXPECT_EQ(Refusal(square + "f 1 2\n"), "line 5: expected three vertices or more, found 2");
  EXPECT_EQ(Refusal(square + "f 1 2 5\n"), "line 5: '5': expected a vertex from 1 to 4");
  EXPECT_EQ(Refusal(square + "f 1 2 -5\n"), "line 5: '-5': expected a vertex from 1 to 4");
  EXPECT_EQ(Refusal(square + "f 1 2 0\n"), "line 5: '0': expected a vertex from 1 to 4");
  EXPECT_EQ(Refusal(square + "f 1 2 3x\n"), "line 5: '3x': expected the number of a vertex");
  EXPECT_EQ(Refusal(square + "f 1 2 3 1\n"), "line 5: '1': expected each vertex of a polygon once");
  EXPECT_EQ(Refusal(square + "v 2 0 0\nf 1 2 5\n"),
            "line 6: expected a triangle with an area, found none in vertices 1, 2 and 5");
  EXPECT_EQ(Refusal(square), "expected lines that begin with f, found none");
}

TEST(Layout, KeepsTheLengthsOfEachTriangle) {
  const Mesh mesh = MakeDisk(3, Saddle(1.5));
  for (int e = 0; e < mesh.Elements(); ++e) {
    const auto flat = FlattenTriangle(mesh, e);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double length =
          std::hypot(flat[2 * j] - flat[2 * i], flat[2 * j + 1] - flat[2 * i + 1]);
      EXPECT_NEAR(length, Norm(mesh.At(mesh.Element(e)[j]) - mesh.At(mesh.Element(e)[i])), 1e-14);
    }
    EXPECT_GT(flat[5], 0);
  }
}

TEST(Layout, BeginsWithoutAFlippedTriangle) {
  for (const Surface& surface : {Cap(2.8), Saddle(1.5), Peak(3, 0.4), Star(0.4, 3), Ribbon(3)}) {
    for (const int rings : {1, 6, 24}) {
      const Mesh mesh = MakeDisk(rings, surface);
      const Embedding embedding = EmbedDisk(mesh);
      double sum = 0;
      for (int e = 0; e < mesh.Elements(); ++e) {
        const auto point = [&](int i) {
          return embedding.points[static_cast<std::size_t>(mesh.Element(e)[i])];
        };
        const PlanePoint a = point(0), b = point(1), c = point(2);
        const double area = ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
        EXPECT_GT(area, 0);
        sum += area;
      }
      EXPECT_NEAR(sum / AreaOf(mesh), 1, 1e-13);
      const PlanePoint left = embedding.points[static_cast<std::size_t>(embedding.left)];
      const PlanePoint right = embedding.points[static_cast<std::size_t>(embedding.right)];
      EXPECT_EQ(left[1], 0);
      EXPECT_EQ(right[1], 0);
      EXPECT_EQ(left[0], -right[0]);
    }
  }
}

TEST(Problems, BeginInTheDomainOfTheirEnergies) {
  for (const Template& of : AllProblems()) {
    int fitting = 0;
    for (const EnergyRow* const energy : DistortionEnergies()) {
      if (!of.Fits(*energy)) continue;
      ++fitting;
      for (const bool coarse : {true, false}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          const Problem problem = of.make(of, *energy, coarse, seed);
          EXPECT_TRUE(Objective(problem).ValueAt(problem.start).in_domain)
              << of.name << energy->name << coarse << seed;
        }
      }
    }
    EXPECT_GT(fitting, 0) << of.name;
  }
}

// MIPS alone leaves the scale of a layout open.
TEST(Problems, LeaveNoMotionOpen) {
  for (const EnergyRow* const energy : DistortionEnergies()) {
    if (energy->dimension != 2) continue;
    const Problem problem = ParameterizeDisk("", *energy, MakeDisk(2, Cap(1)));
    const auto fixed = std::ranges::count(problem.fixed, true);
    EXPECT_EQ(fixed, energy->name.ends_with("/mips") ? 4 : 3) << energy->name;
  }
  const Descent run = SolveBy(ProblemNamed("disk_star", "mips"), "analytic");
  EXPECT_EQ(run.outcome, Outcome::kConverged);
  EXPECT_EQ(run.falling, 0);
  EXPECT_LT(run.value, 1e-12);
}

TEST(Problems, AreDrawnFromTheirSeed) {
  const auto start = [](std::uint64_t seed) {
    return ProblemNamed("bar_twist", "arap", seed).start;
  };
  EXPECT_EQ(start(1), start(1));
  EXPECT_NE(start(1), start(2));
}

// In general position and in the domain of all energies: a little off what the catalogue begins
// with, with inertia.
struct Posed {
  explicit Posed(const EnergyRow& energy)
      : problem(energy.dimension == 2 ? ParameterizeDisk("", energy, MakeDisk(2, Saddle(0.7)))
                                      : HeldInOne(SolidAtRest("", energy, MakeBlock(1, 1, 2)))),
        objective(problem) {
    x = problem.start;
    Draws draws(7, 7, 7);
    std::vector<double> weight, predicted;
    for (double& coordinate : x) {
      coordinate += 0.05 * draws.Uniform();
      weight.push_back(draws.Uniform());
      predicted.push_back(draws.Uniform());
    }
    objective.SetInertia(weight, predicted);
  }

  static Problem HeldInOne(Problem of) {
    of.fixed[0] = true;
    return of;
  }

  Problem problem;
  Objective objective;
  std::vector<double> x;
};

TEST(Objectives, HaveTheGradientAndTheHessianOfTheirValue) {
  constexpr double kStep = 1e-5;
  for (const EnergyRow* const energy : DistortionEnergies()) {
    const Posed posed(*energy);
    const Objective& objective = posed.objective;
    const Vector gradient = objective.GradientAt(posed.x);
    Hessian hessian(objective, *RowOf(*energy, "none"));
    hessian.Evaluate(posed.x);
    hessian.Assemble();
    const Eigen::MatrixXd dense = Eigen::MatrixXd(hessian.Sum()).selfadjointView<Eigen::Lower>();
    Vector gradient_error(objective.Free());
    Eigen::MatrixXd hessian_error(objective.Free(), objective.Free());
    for (int n = 0; n < objective.Free(); ++n) {
      const auto i =
          static_cast<std::size_t>(objective.FreeCoordinates()[static_cast<std::size_t>(n)]);
      std::vector<double> above = posed.x, below = posed.x;
      above[i] += kStep;
      below[i] -= kStep;
      const double slope =
          objective.ValueAt(above).LessThose(objective.ValueAt(below)) / (2 * kStep);
      gradient_error[n] = slope - gradient[n];
      hessian_error.col(n) =
          (objective.GradientAt(above) - objective.GradientAt(below)) / (2 * kStep) - dense.col(n);
    }
    EXPECT_LT(gradient_error.norm(), 1e-7 * gradient.norm()) << energy->name;
    EXPECT_LT(hessian_error.norm(), 1e-7 * dense.norm()) << energy->name;
  }
}

TEST(Objectives, AreOutOfTheirDomainWhereOneElementIs) {
  for (const EnergyRow* const energy : DistortionEnergies()) {
    if (energy->mirror.empty()) continue;
    Posed posed(*energy);
    EXPECT_TRUE(posed.objective.ValueAt(posed.x).in_domain);
    // The first vertex of the first element far beyond the others.
    const auto first = static_cast<std::size_t>(posed.problem.elements[0] * energy->dimension);
    for (std::size_t i = 0; i < static_cast<std::size_t>(energy->dimension); ++i)
      posed.x[first + i] += 5;
    EXPECT_FALSE(posed.objective.ValueAt(posed.x).in_domain) << energy->name;
  }
}

TEST(Objectives, AreOutOfTheirDomainWhereTheFirstOfSeveralElementsIs) {
  const EnergyRow& energy = EnergyNamed("tetrahedron/symmetric_dirichlet");
  Problem problem = SolidAtRest("", energy, MakeBlock(1, 1, 1));
  // Vertex 1 is in the first element and not in the last.
  problem.start[3] = -1;
  const Terms terms = Objective(problem).ValueAt(problem.start);
  EXPECT_EQ(terms.of.front(), 0);  // as outside the domain
  EXPECT_EQ(terms.of.back(), 0);   // as at rest
  EXPECT_FALSE(terms.in_domain);
}

TEST(FirstRoots, AreTheFirst) {
  const double most = 1 / 0.9;
  EXPECT_NEAR(FirstRoot({1, -4.5, 4.5, 0}, most), 1.0 / 3, 1e-15);       // roots 1/3, 2/3
  EXPECT_NEAR(FirstRoot({1, -2, 0, 0}, most), 0.5, 1e-15);               // linear
  EXPECT_NEAR(FirstRoot({6, -11, 6, -1}, 4), 1, 1e-15);                  // roots 1, 2, 3
  EXPECT_NEAR(FirstRoot({1, 0, 0, -8}, most), 0.5, 1e-15);               // triple derivative
  EXPECT_NEAR(FirstRoot({0.5, -3, 5.25, -2.25}, most), 1.0 / 3, 1e-15);  // falls, rises, falls
  // None, or none near enough.
  EXPECT_EQ(FirstRoot({1, 1, 1, 1}, most), INFINITY);
  EXPECT_EQ(FirstRoot({1, 0, 0, 0}, most), INFINITY);
  EXPECT_EQ(FirstRoot({1, -0.5, 0, 0}, most), INFINITY);
  EXPECT_EQ(FirstRoot({1, -1.9, 1, 0}, most), INFINITY);  // a minimum of 0.0975
  // One that touches 0, or would but for rounding.
  EXPECT_NEAR(FirstRoot({1, -4, 4, 0}, most), 0.5, 1e-7);
  EXPECT_NEAR(FirstRoot({0x1p-2 + 0x1p-54, -1, 1, 0}, most), 0.5, 1e-7);
}

TEST(FirstRoots, AreNotPassed) {
  Draws draws(1, 2, 3);
  int found = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::array<double, 4> c = {draws.Uniform(), 4 * draws.Normal(), 4 * draws.Normal(),
                                     4 * draws.Normal()};
    const double root = FirstRoot(c, 1);
    found += root <= 1;
    const double end = std::min(root, 1.0);
    for (int k = 1; k < 200; ++k) {
      const double t = end * k / 200;
      ASSERT_GT(c[0] + t * (c[1] + t * (c[2] + t * c[3])), -1e-14) << i;
    }
    if (root > 1) continue;
    const double t = root * (1 + 1e-6), value = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    ASSERT_LT(std::abs(value), 1e-4) << i;
  }
  EXPECT_GT(found, 3000);
}

// One element at rest, its first vertex in the origin, so that a step may scale each axis.
Problem OneElement(const EnergyRow& energy) {
  Mesh mesh;
  if (energy.dimension == 2) {
    mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.elements = {0, 1, 2};
    Problem problem = ParameterizeDisk("", energy, mesh);
    problem.start = {0, 0, 1, 0, 0, 1};
    return problem;
  }
  mesh.size = 4;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.elements = {0, 1, 2, 3};
  return SolidAtRest("", energy, mesh);
}

// All forces are of a volume 1/6 and stiffness 1; the shape function of the first vertex has slope
// sqrt 3, those of the others 1.
TEST(Objectives, MeasureForcesByTheirSteepestFreeVertex) {
  Problem problem = OneElement(EnergyNamed("tetrahedron/arap"));
  EXPECT_NEAR(Objective(problem).CharacteristicForce(), std::sqrt(3) / 6, 1e-15);
  problem.fixed[0] = problem.fixed[1] = problem.fixed[2] = true;
  EXPECT_NEAR(Objective(problem).CharacteristicForce(), 1.0 / 6, 1e-15);
}

// The whole step turns the element by 180 degrees: its determinant is positive again, and was not
// between.
TEST(StepLimits, StopBeforeAnInversionThatTheWholeStepJumpsOver) {
  const Problem flat = OneElement(EnergyNamed("triangle/symmetric_dirichlet"));
  const std::vector<double> step = {0, 0, -3, 0, 0, -1.5};  // (1 - 3 t) (1 - 1.5 t)
  std::vector<double> whole = flat.start;
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] += step[i];
  EXPECT_TRUE(Objective(flat).ValueAt(whole).in_domain);
  EXPECT_NEAR(StepLimit(flat, flat.start, step, 1), 1.0 / 3, 1e-15);

  const Problem solid = OneElement(EnergyNamed("tetrahedron/symmetric_dirichlet"));
  const std::vector<double> turn = {0, 0, 0, -3, 0, 0, 0, -1.5, 0, 0, 0, 0.25};
  EXPECT_NEAR(StepLimit(solid, solid.start, turn, 1), 1.0 / 3, 1e-15);
  // All three axes through 0, at different times.
  const std::vector<double> inversion = {0, 0, 0, -1.25, 0, 0, 0, -4, 0, 0, 0, -2};
  EXPECT_NEAR(StepLimit(solid, solid.start, inversion, 1), 0.25, 1e-15);
  EXPECT_EQ(StepLimit(solid, solid.start, std::vector<double>(12, 1.0), 1), 1);
}

// A whole step would jump over an inversion, to an energy that is lower.
TEST(Solver, KeepsElementsFromInverting) {
  Problem problem = OneElement(EnergyNamed("triangle/neo_hookean"));
  problem.fixed = {true, true, false, false, false, false};
  problem.start = {0, 0, 1.405, 0.666, -1.225, 2.707};
  Settings settings;
  settings.most_iterations = 1;
  EXPECT_NEAR(SolveBy(problem, "absolute", settings).iterations.front().step, 0.9 * 0.318, 1e-3);
  for (const char* name : {"disk_peak", "disk_star", "bar_bend", "block_squash"}) {
    const Problem whole = ProblemNamed(name, "symmetric_dirichlet");
    const Descent run = SolveBy(whole, "analytic");
    EXPECT_EQ(run.outcome, Outcome::kConverged) << name;
    EXPECT_TRUE(Objective(whole).ValueAt(run.x).in_domain);
  }
}

// At stretches (a, -1) the energy of ARAP's triangle is ((a - 1)^2 + 4)/2 where a > 1. A whole step
// goes to a = 1, where no rotation is nearest: outside the domain, and the value there is 0.
TEST(Solver, DoesNotTakeWhatIsOutsideTheDomainForADecrease) {
  Problem problem = OneElement(EnergyNamed("triangle/arap"));
  problem.fixed = {true, true, false, true, true, true};
  problem.start = {0, 0, 3, 0, 0, -1};
  EXPECT_NEAR(Objective(problem).ValueAt(problem.start).Sum(), 4, 1e-15);
  Settings settings;
  settings.most_iterations = 1;
  EXPECT_EQ(SolveBy(problem, "none", settings).iterations.front().step, 0.5);
}

// Symmetric Dirichlet knows no Poisson effect: uniform stretch is the least.
TEST(Solver, FindsKnownMinima) {
  const auto psi = [](double s) { return (s * s + 1 / (s * s) - 2) / 2; };
  const auto value = [](const char* problem) {
    return SolveBy(ProblemNamed(problem, "symmetric_dirichlet"), "analytic").value;
  };
  EXPECT_NEAR(value("bar_stretch"), 4 * psi(2), 1e-12);
  EXPECT_NEAR(value("block_squash"), psi(0.5), 1e-12);
  EXPECT_NEAR(value("disk_star"), 0, 1e-12);
}

TEST(Solver, BringsBackWhatWasDisplaced) {
  for (const EnergyRow* const energy : DistortionEnergies()) {
    if (energy->dimension != 3) continue;
    const Mesh block = MakeBlock(2, 2, 2);
    Problem problem = SolidAtRest("", *energy, block);
    Draws draws(3, 1, 4);
    for (std::size_t i = 0; i < problem.start.size(); ++i) {
      problem.fixed[i] = block.rest[i / 3][2] == 0;
      if (!problem.fixed[i]) problem.start[i] += 0.1 * draws.Uniform();
    }
    for (const char* filter : {"analytic", "numeric", "nearest", "absolute", "numeric_frame"}) {
      const Descent run = SolveBy(problem, filter);
      EXPECT_EQ(run.outcome, Outcome::kConverged) << energy->name << filter;
      EXPECT_LT(run.value, 1e-12) << energy->name << filter;
      for (std::size_t i = 0; i < run.x.size(); ++i)
        EXPECT_NEAR(run.x[i], block.rest[i / 3][i % 3], 1e-5) << energy->name << filter;
    }
  }
}

TEST(Solver, GoesTheSameWayByEqualFilters) {
  for (const char* name : {"disk_peak", "disk_ball", "bar_bend"}) {
    for (const char* energy : {"symmetric_dirichlet", "arap"}) {
      const Problem problem = ProblemNamed(name, energy);
      const Descent analytic = SolveBy(problem, "analytic"),
                    frame = SolveBy(problem, "numeric_frame");
      EXPECT_EQ(analytic.iterations.size(), frame.iterations.size()) << name << energy;
      EXPECT_NEAR(analytic.value, frame.value, 1e-12 * analytic.value);
      const Descent numeric = SolveBy(problem, "numeric"), nearest = SolveBy(problem, "nearest");
      EXPECT_EQ(numeric.iterations.size(), nearest.iterations.size()) << name << energy;
      EXPECT_NE(numeric.iterations.size(), analytic.iterations.size()) << name << energy;
    }
  }
}

TEST(Solver, EndsWhereTheEnergyDoesNotFall) {
  for (const auto& [name, energy] :
       {std::pair("disk_hemisphere", "mips"), std::pair("bar_bend_abrupt", "arap")}) {
    const Descent run = SolveBy(ProblemNamed(name, energy), "none");
    EXPECT_EQ(run.outcome, Outcome::kNotDescending) << name;
    EXPECT_GT(run.indefinite, 0);
    EXPECT_EQ(run.factorizations, static_cast<int>(run.iterations.size()) + 1);
    EXPECT_TRUE(run.reached.empty());
  }
}

TEST(Solver, SaysThatItWasStopped) {
  Settings settings;
  settings.most_iterations = 3;
  const Descent run =
      SolveBy(ProblemNamed("disk_peak", "symmetric_dirichlet"), "analytic", settings);
  EXPECT_EQ(run.outcome, Outcome::kIterationLimit);
  EXPECT_EQ(run.iterations.size(), 3u);
}

TEST(Solver, RefusesAStartOutsideTheDomain) {
  Problem problem = OneElement(EnergyNamed("triangle/mips"));
  problem.start = {0, 0, 0, 1, 1, 0};
  EXPECT_THROW(SolveBy(problem, "analytic"), std::invalid_argument);
}

TEST(Solver, GoesDownAndKeepsCount) {
  const Descent run = SolveBy(ProblemNamed("disk_cone", "symmetric_dirichlet"), "analytic");
  ASSERT_EQ(run.reached.size(), 2u);
  EXPECT_LT(run.reached[0].iterations, run.reached[1].iterations);
  EXPECT_EQ(run.reached[1].iterations, static_cast<int>(run.iterations.size()));
  EXPECT_LE(run.gradient, 1e-8);
  EXPECT_LE(run.reached[0].seconds, run.reached[1].seconds);
  const auto first = static_cast<std::size_t>(run.reached[0].iterations);
  EXPECT_LE(run.iterations[first].gradient, 1e-4);
  EXPECT_GT(run.iterations[first - 1].gradient, 1e-4);
  for (std::size_t i = 1; i < run.iterations.size(); ++i)
    EXPECT_LE(run.iterations[i].value, run.iterations[i - 1].value * (1 + 1e-14));
  // The first step was halved, for the energy would have risen; the last was not.
  EXPECT_EQ(run.iterations.front().step, 0.5);
  EXPECT_EQ(run.iterations.back().step, 1);
  EXPECT_GT(run.evaluations, run.factorizations);
  EXPECT_EQ(run.indefinite, 0);
}

TEST(Solver, HasTheSameBitsEachTime) {
  for (const char* name : {"bar_twist", "bar_swing"}) {
    const Problem problem = ProblemNamed(name, "stable_neo_hookean");
    const Descent one = SolveBy(problem, "nearest"), two = SolveBy(problem, "nearest");
    EXPECT_EQ(one.x, two.x);
    EXPECT_EQ(one.value, two.value);
    EXPECT_EQ(one.evaluations, two.evaluations);
    // Over all steps of time.
    EXPECT_EQ(one.reached.back().iterations, static_cast<int>(one.iterations.size()));
  }
}

TEST(Solver, AgreesWithConjugateGradients) {
  Settings settings;
  settings.solver = LinearSolver::kConjugateGradients;
  for (const char* name : {"disk_saddle", "bar_bend"}) {
    const Problem problem = ProblemNamed(name, "symmetric_dirichlet");
    const Descent cg = SolveBy(problem, "analytic", settings), ldlt = SolveBy(problem, "analytic");
    EXPECT_EQ(cg.iterations.size(), ldlt.iterations.size()) << name;
    EXPECT_NEAR(cg.value, ldlt.value, 1e-10) << name;
    EXPECT_GT(cg.solver_iterations, 0);
    EXPECT_EQ(ldlt.solver_iterations, 0);
  }
}

// Nothing holds the block: backward Euler moves all of it by g dt^2 (1 + 2 + ...).
TEST(Solver, LetsAFreeBlockFall) {
  const Mesh block = MakeBlock(1, 2, 1);
  Problem problem = SolidAtRest("", EnergyNamed("tetrahedron/arap"), block);
  problem.motion = Motion{4, 0.5, std::vector<double>(block.rest.size(), 3.0), {0, 0, -2}};
  const Descent run = SolveBy(problem, "analytic");
  EXPECT_EQ(run.outcome, Outcome::kConverged);
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    const double fallen = i % 3 == 2 ? -2 * 0.25 * (1 + 2 + 3 + 4) : 0;
    EXPECT_NEAR(run.x[i], problem.start[i] + fallen, 1e-7);
  }
  // A step each: the energy is quadratic along the way.
  EXPECT_EQ(run.iterations.size(), 4u);
}

// m (x - x0 - dt v)/dt^2 = m g - grad psi after a step from rest.
TEST(Solver, BalancesForcesAfterAStepOfTime) {
  Problem problem = ProblemNamed("bar_swing", "arap");
  Motion& motion = *problem.motion;
  motion.steps = 1;
  motion.dt = 0.5;
  const Descent run = SolveBy(problem, "analytic");
  const Objective elastic(problem);
  const Vector gradient = elastic.GradientAt(run.x);
  EXPECT_GT(gradient.norm(), 0.01);
  for (int n = 0; n < elastic.Free(); ++n) {
    const auto i = static_cast<std::size_t>(elastic.FreeCoordinates()[static_cast<std::size_t>(n)]);
    const double acceleration = (run.x[i] - problem.start[i]) / (motion.dt * motion.dt);
    EXPECT_NEAR(motion.mass[i / 3] * (acceleration - motion.gravity[i % 3]), -gradient[n], 1e-7);
  }
}

// A column pressed straight down is in balance, and buckles at a touch.
TEST(Solver, TellsASaddlePointFromAMinimum) {
  const Mesh column = MakeBlock(1, 1, 8);
  Problem problem = SolidAtRest("", EnergyNamed("tetrahedron/arap"), column);
  for (std::size_t i = 0; i < problem.start.size(); ++i) {
    const double height = column.rest[i / 3][2];
    problem.fixed[i] = height == 0 || height == 8;
    if (i % 3 == 2) problem.start[i] *= 0.5;
  }
  const Descent straight = SolveBy(problem, "analytic");
  EXPECT_EQ(straight.outcome, Outcome::kConverged);
  EXPECT_GT(straight.falling, 0);
  problem.start[3 * 17] += 0.1;
  const Descent buckled = SolveBy(problem, "analytic");
  EXPECT_EQ(buckled.outcome, Outcome::kConverged);
  EXPECT_EQ(buckled.falling, 0);
  EXPECT_LT(buckled.value, 0.9 * straight.value);
}

// A step of time that ends early has met the loose tolerance, and those after it have not.
TEST(Solver, MeetsNoToleranceInStepsThatItDidNotTake) {
  Settings settings;
  settings.most_iterations = 2;
  settings.tolerances = {0.1, 1e-12};
  Problem problem = ProblemNamed("bar_swing", "symmetric_dirichlet");
  const Descent five = SolveBy(problem, "analytic", settings);
  EXPECT_EQ(five.outcome, Outcome::kIterationLimit);
  EXPECT_TRUE(five.reached.empty());
  problem.motion->steps = 1;
  EXPECT_EQ(SolveBy(problem, "analytic", settings).reached.size(), 1u);
}

TEST(Profiles, CountWhatIsNearTheBest) {
  const EnergyRow& energy = EnergyNamed("triangle/arap");
  const auto contest = [&](int analytic, int numeric) {
    Contest c{ProblemNamed("disk_cone", "arap"), "", {}};
    for (const auto& [filter, iterations] :
         {std::pair("analytic", analytic), std::pair("numeric", numeric)}) {
      Descent run;
      run.falling = iterations == 1;  // to a saddle point
      if (iterations > 0) run.reached = {{1e-4, iterations, 0.1 * iterations}};
      c.entries.push_back({RowOf(energy, filter), run});
    }
    return c;
  };
  // 0: never.
  const std::vector<Contest> contests = {contest(10, 10), contest(10, 16), contest(20, 10),
                                         contest(6, 0),   contest(0, 0),   contest(30, 1)};
  const auto profiles = ProfilesOf(contests, {"none", "numeric", "analytic"}, {1e-4});
  ASSERT_EQ(profiles.size(), 2u);
  for (const Profile& profile : profiles) {
    ASSERT_EQ(profile.lines.size(), 2u);
    EXPECT_EQ(profile.lines[0].filter, "numeric");
    EXPECT_EQ(profile.lines[0].solved, (std::vector<int>{2, 2, 3, 3}));
    EXPECT_EQ(profile.lines[1].solved, (std::vector<int>{4, 4, 5, 5}));
  }
}

TEST(Rows, AreInLanesWhereTheyCanBe) {
  const EnergyRow& energy = EnergyNamed("tetrahedron/arap");
  EXPECT_EQ(RowOf(energy, "analytic")->scalar, "f64x8");
  EXPECT_EQ(RowOf(energy, "numeric")->scalar, "f64");
  EXPECT_EQ(RowOf(energy, "nothing"), nullptr);
}

}  // namespace
}  // namespace definite::newton
