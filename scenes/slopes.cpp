#include "scenes/slopes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace definite::scenes {

namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr int kFrames = 30;
constexpr double kEdgeLength = 1;  // m
constexpr double kSeconds = kFrames * kFrame;

// A frame on the slope: down it, along it, and its upward normal.
struct Slope {
  double angle;
  Point down, along, normal;
};
Slope DrawSlope(Draws& draws) {
  const double angle = 0.2 + 0.2 * draws.OpenUniform();
  const double turn = 6.283185307179586 * draws.OpenUniform();
  const Point level = {std::cos(turn), std::sin(turn), 0}, up = {0, 0, 1};
  const Point down = std::cos(angle) * level + (-std::sin(angle)) * up;
  const Point normal = std::sin(angle) * level + std::cos(angle) * up;
  return {angle, down, Cross(normal, down), normal};
}

double MassOf(const Case& c) { return kFrame * kFrame * kSlopeStiffness / c.mu; }

Contacts ContactsOf(const Case& c, const std::string& stencil) {
  Contacts contacts;
  contacts.stencil = stencil;
  contacts.length = c.length;
  contacts.vertices = {0, 1, 2, 3};
  contacts.k = kSlopeStiffness;
  contacts.eps = kSlopeEps;
  // Nothing penetrates at a positive level.
  contacts.memory = c.level < 0 ? Memory::kScene : Memory::kNone;
  return contacts;
}

void ApplySlopeChange(const std::string& change, Trial& trial) {
  Model& model = trial.model;
  if (change == "contact") {
    model.contacts.vertices.clear();
    model.contacts.orientation.clear();
  } else if (change == "load") {
    std::ranges::fill(model.load, 0.0);
  } else if (change == "side_memory") {
    const bool there = model.contacts.memory != Memory::kNone;
    model.contacts.memory = there ? Memory::kNone : Memory::kScene;
  } else if (change == "springs" || change == "damping") {
    model.elastic = {{"strand/stretch/quadratic", {0, 1}, {kSlopeStiffness, kEdgeLength}}};
    if (change == "damping") trial.method.rayleigh = 0.006;
  } else if (change == "cg") {
    trial.method.solver = Solver::kConjugateGradients;
  } else if (change == "newton" || change == "line_search") {
    trial.method.iterations = change == "newton" ? 5 : 20;
    trial.method.line_search = change == "line_search";
  } else if (!change.empty()) {
    throw std::runtime_error(fmt::format("no change '{}'", change));
  }
}

void Finish(const Case& c, const Slope& slope, double l, double acceleration, Trial& trial) {
  trial.method.filter = c.filter;
  trial.substeps = c.substeps;
  trial.frames = kFrames;
  trial.watch.downhill = slope.down;
  trial.watch.free_slide = acceleration * kSeconds * kSeconds / 2;
  trial.watch.expected_slip = std::abs(l) * std::tan(slope.angle);
  ApplySlopeChange(c.change, trial);
}

}  // namespace

Trial VertexOnSlope(const Case& c, Draws& draws) {
  const Slope slope = DrawSlope(draws);
  const double mass = MassOf(c), press = mass * kGravity * std::cos(slope.angle);
  const double l = kSlopeEps - press / (2 * kSlopeStiffness);
  Trial trial;
  Model& model = trial.model;
  const int vertex = model.AddVertex(l * slope.normal, mass);
  model.load[2] = -mass * kGravity;
  // A triangle turned at random, far larger than the way.
  const double turn = 6.283185307179586 * draws.OpenUniform(), size = 100;
  for (int i = 0; i < 3; ++i) {
    const double angle = turn + i * 6.283185307179586 / 3;
    model.AddVertex((size * std::cos(angle)) * slope.down + (size * std::sin(angle)) * slope.along,
                    mass, true);
  }
  model.contacts = ContactsOf(c, "vertex_face");
  // Outside is where the normal points: there the triple product has this sign.
  std::vector<double> above = model.x;
  for (std::size_t i = 0; i < 3; ++i) above[i] = slope.normal[i];
  model.contacts.orientation = {TripleProduct(model.contacts, 0, above) < 0 ? -1 : 1};
  Finish(c, slope, l, kGravity * std::sin(slope.angle), trial);
  trial.watch.sliders = {vertex};
  return trial;
}

Trial EdgeOnSlope(const Case& c, Draws& draws) {
  const Slope slope = DrawSlope(draws);
  const double mass = MassOf(c), l = c.level * kSlopeEps;
  const double load = 2 * kSlopeStiffness * (kSlopeEps - l) / std::cos(slope.angle);
  constexpr double kHalf = kEdgeLength / 2, kLong = 1000;
  Trial trial;
  Model& model = trial.model;
  for (const double side : {-kHalf, kHalf}) {
    const int v = model.AddVertex(side * slope.along + l * slope.normal, mass);
    model.load[static_cast<std::size_t>(3 * v + 2)] = -load / 2;
  }
  model.AddVertex((-kLong) * slope.down, mass, true);
  model.AddVertex(kLong * slope.down, mass, true);
  model.contacts = ContactsOf(c, "edge_edge");
  std::vector<double> above = model.x;
  for (std::size_t i = 0; i < 6; ++i) above[i] += slope.normal[i % 3];
  model.contacts.orientation = {TripleProduct(model.contacts, 0, above) < 0 ? -1 : 1};
  Finish(c, slope, l, load * std::sin(slope.angle) / (2 * mass), trial);
  trial.watch.sliders = {0, 1};
  return trial;
}

std::vector<Change> SlopeChanges(bool is_edge) {
  std::vector<Change> changes = {
      {"contact", "no contact", true, "it is what the claim is of"},
      {"load", "nothing presses", true, "without it nothing touches"},
  };
  if (is_edge) {
    changes.push_back(
        {"springs", "a spring along the free edge", false, "nothing changes with it"});
    changes.push_back({"damping", "that spring, and Rayleigh damping of 0.006 s", false,
                       "nothing elastic moves"});
  }
  changes.push_back(
      {"cg", "conjugate gradients in place of LDLT", false, "pivots count negative eigenvalues"});
  changes.push_back(
      {"newton", "5 iterations of Newton's method", false, "the paper solves once a step"});
  changes.push_back({"line_search", "20 iterations of Newton's method with a line search", false,
                     "the paper has none"});
  return changes;
}

}  // namespace definite::scenes
