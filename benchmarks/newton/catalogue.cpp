#include "benchmarks/newton/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "benchmarks/harness/sampling/random.hpp"
#include "benchmarks/newton/shapes.hpp"

namespace definite::newton {

namespace {

using std::numbers::pi;

constexpr int kRings = 24, kCoarseRings = 6;
constexpr int kBarWidth = 5, kCoarseBarWidth = 2, kBarAspect = 4;  // in cubes
constexpr int kBlockWidth = 7, kCoarseBlockWidth = 3;
constexpr double kJitter = 0.1;  // of an edge of a cube, in each coordinate

template <Surface (*kMake)()>
Problem Flatten(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t) {
  return ParameterizeDisk(std::string(of.name), energy,
                          MakeDisk(coarse ? kCoarseRings : kRings, kMake()));
}

// A solid of width 1 that stands on z = 0.
Mesh MakeSolid(int width, int aspect) {
  Mesh mesh = MakeBlock(width, width, aspect * width);
  for (Point& point : mesh.rest) point = (1.0 / width) * point;
  return mesh;
}
Mesh MakeBar(bool coarse) { return MakeSolid(coarse ? kCoarseBarWidth : kBarWidth, kBarAspect); }

// How far up a vertex is, of the height 1.
double HeightOf(const Mesh& mesh, const Point& point) { return point[2] / mesh.rest.back()[2]; }

// Where a motion of the top has a point that takes part in it to the share s.
using Motions = Point (*)(const Point& rest, double s);

Point Turned(const Point& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), x = p[0] - 0.5, y = p[1] - 0.5;
  return {0.5 + c * x - s * y, 0.5 + s * x + c * y, p[2]};
}
Point Twist(const Point& rest, double s) { return Turned(rest, pi * s); }
// No element between a held top and a bottom becomes flat by symmetry, as it would by half a turn.
Point LesserTwist(const Point& rest, double s) { return Turned(rest, pi / 1.2 * s); }
Point Stretch(const Point& rest, double s) { return {rest[0], rest[1], rest[2] * (1 + s)}; }
Point Squash(const Point& rest, double s) { return {rest[0], rest[1], rest[2] * (1 - s / 2)}; }
// Along half a circle as long as the bar.
Point Bend(const Point& rest, double s) {
  const double radius = kBarAspect / pi, angle = pi * s, from_centre = radius + 0.5 - rest[0];
  return {radius + 0.5 - from_centre * std::cos(angle), rest[1], from_centre * std::sin(angle)};
}

// The bottom held, the top moved and held.
void HoldEnds(const Mesh& mesh, Motions motion, Problem& problem) {
  for (std::size_t v = 0; v < mesh.rest.size(); ++v) {
    const double height = HeightOf(mesh, mesh.rest[v]);
    if (height != 0 && height != 1) continue;
    std::fill_n(problem.fixed.begin() + static_cast<long>(3 * v), 3, true);
    std::ranges::copy(motion(mesh.rest[v], height), &problem.start[3 * v]);
  }
}

// Each vertex is moved a little at random, and then takes part in the motion as it is high: an
// element of a cube that is off by so little is not inverted.
template <Motions kMotion>
Problem Spread(const Template& of, const EnergyRow& energy, const Mesh& mesh, double edge,
               std::uint64_t seed) {
  Problem problem = SolidAtRest(std::string(of.name), energy, mesh);
  HoldEnds(mesh, kMotion, problem);
  Draws draws(StreamId(of.name), seed, 0);
  for (std::size_t v = 0; v < mesh.rest.size(); ++v) {
    if (problem.fixed[3 * v]) continue;
    Point off = mesh.rest[v];
    for (double& coordinate : off) coordinate += kJitter * edge * (2 * draws.Uniform() - 1);
    std::ranges::copy(kMotion(off, HeightOf(mesh, off)), &problem.start[3 * v]);
  }
  return problem;
}
template <Motions kMotion>
Problem MoveBar(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t seed) {
  return Spread<kMotion>(of, energy, MakeBar(coarse), 1.0 / (coarse ? kCoarseBarWidth : kBarWidth),
                         seed);
}
Problem SquashBlock(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t seed) {
  const int width = coarse ? kCoarseBlockWidth : kBlockWidth;
  return Spread<Squash>(of, energy, MakeSolid(width, 1), 1.0 / width, seed);
}

// All but the top stays where it was.
template <Motions kMotion>
Problem MoveBarAbruptly(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t) {
  const Mesh mesh = MakeBar(coarse);
  Problem problem = SolidAtRest(std::string(of.name), energy, mesh);
  HoldEnds(mesh, kMotion, problem);
  return problem;
}

Problem ScrambleBlock(const Template& of, const EnergyRow& energy, bool coarse,
                      std::uint64_t seed) {
  const Mesh mesh = MakeSolid(coarse ? kCoarseBlockWidth : kBlockWidth, 1);
  Problem problem = SolidAtRest(std::string(of.name), energy, mesh);
  Draws draws(StreamId(of.name), seed, 0);
  for (std::size_t i = 0; i < problem.start.size(); ++i) {
    const bool held = mesh.rest[i / 3][2] == 0;
    problem.fixed[i] = held;
    if (!held) problem.start[i] = draws.Uniform();
  }
  return problem;
}

Problem SwingBar(const Template& of, const EnergyRow& energy, bool coarse, std::uint64_t) {
  const Mesh mesh = MakeBar(coarse);
  Problem problem = SolidAtRest(std::string(of.name), energy, mesh);
  Motion motion{5, 1, std::vector<double>(mesh.rest.size()), {0.2, 0, 0}};
  for (int e = 0; e < mesh.Elements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      motion.mass[static_cast<std::size_t>(mesh.Element(e)[i])] += MeasureOf(mesh, e) / 4;
    }
  }
  for (std::size_t i = 0; i < problem.start.size(); ++i) {
    problem.fixed[i] = mesh.rest[i / 3][2] == 0;
  }
  problem.motion = std::move(motion);
  return problem;
}

// Whose Surface functions have no arguments left.
Surface Hemisphere() { return Cap(pi / 2); }
Surface Ball() { return Cap(0.9 * pi); }
Surface SteepSaddle() { return Saddle(1.5); }
Surface WavySheet() { return Waves(0.3, 6); }
Surface SteepPeak() { return Peak(3, 0.4); }
Surface SteepCone() { return Cone(2); }
Surface ThreeArms() { return Star(0.4, 3); }
Surface LongRibbon() { return Ribbon(3); }

}  // namespace

bool Template::Fits(const EnergyRow& energy) const {
  return energy.name.starts_with("distortion/") && energy.stencil == stencil &&
         (!inverts || energy.mirror.empty());
}

std::span<const Template> AllProblems() {
  static constexpr std::string_view kPlane = "triangle", kSolid = "tetrahedron";
  static constexpr Template kAll[] = {
      {"disk_hemisphere", "half a sphere, laid out", kPlane, false, Flatten<Hemisphere>},
      {"disk_ball", "a sphere less 18 degrees about its pole, laid out", kPlane, false,
       Flatten<Ball>},
      {"disk_saddle", "z = 1.5 (x^2 - y^2), laid out", kPlane, false, Flatten<SteepSaddle>},
      {"disk_waves", "z = 0.3 sin(6 x) sin(6 y), laid out", kPlane, false, Flatten<WavySheet>},
      {"disk_peak", "z = 3 exp(-(r/0.4)^2) about (0.2, 0.1), laid out", kPlane, false,
       Flatten<SteepPeak>},
      {"disk_cone", "a cone twice as high as its radius, laid out", kPlane, false,
       Flatten<SteepCone>},
      {"disk_star", "a plane star of 3 arms: the least energy is 0", kPlane, false,
       Flatten<ThreeArms>},
      {"disk_ribbon", "an ellipse 3 times as long as wide, rolled, laid out", kPlane, false,
       Flatten<LongRibbon>},
      {"bar_twist", "twisted by 180 degrees; start: spread along the bar, jittered", kSolid, false,
       MoveBar<Twist>},
      {"bar_stretch", "stretched to twice its length; start: likewise", kSolid, false,
       MoveBar<Stretch>},
      {"bar_bend", "bent to half a circle; start: likewise", kSolid, false, MoveBar<Bend>},
      {"block_squash", "pressed to half its height; start: likewise", kSolid, false, SquashBlock},
      {"bar_twist_abrupt", "twisted by 150 degrees; start: all but the top at rest", kSolid, true,
       MoveBarAbruptly<LesserTwist>},
      {"bar_bend_abrupt", "bent to half a circle; start: all but the top at rest", kSolid, true,
       MoveBarAbruptly<Bend>},
      {"block_scrambled", "its bottom held; start: all else anywhere in the block", kSolid, true,
       ScrambleBlock},
      {"bar_swing", "5 steps of 1 s of backward Euler from rest, sideways gravity 0.2", kSolid,
       false, SwingBar},
  };
  return kAll;
}

}  // namespace definite::newton
