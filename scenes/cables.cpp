#include "scenes/cables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace definite::scenes {

namespace {

double Symmetric(Draws& draws, double reach) { return reach * (2 * draws.OpenUniform() - 1); }

constexpr double kMoveSeconds = 1, kHoldSeconds = 2;

// Adds a cable from `from` to `to`; its ends move with `velocity`. Gives its first vertex.
int AddCable(const Cables& cables, const Point& from, const Point& to, const Point& velocity,
             double mass, bool all_scripted, Draws& draws, Model& model) {
  const int first = model.Size();
  for (int i = 0; i <= cables.segments; ++i) {
    const double t = static_cast<double>(i) / cables.segments;
    Point at = (1 - t) * from + t * to;
    const bool is_end = i == 0 || i == cables.segments;
    // Drawn for every vertex, so that nothing else changes with the noise.
    Point noise;
    for (double& n : noise) n = Symmetric(draws, 1);
    const double weight = std::exp(Symmetric(draws, 1) * cables.mass_spread);
    if (!is_end) at = at + cables.noise * noise;
    const int vertex = model.AddVertex(at, mass * weight, is_end || all_scripted, velocity);
    model.load[static_cast<std::size_t>(3 * vertex + 2)] = -cables.gravity * mass * weight;
  }
  return first;
}

void AddPairs(int segments, int a, int b, int orientation, Contacts& contacts) {
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) {
      for (const int v : {a + i, a + i + 1, b + j, b + j + 1}) contacts.vertices.push_back(v);
      contacts.orientation.push_back(orientation);
    }
  }
}

// What a scene can have or not.
struct Term {
  std::string_view name;
  std::string_view without, with;       // what removing it, and adding it, means
  std::string_view why_has, why_lacks;  // empty where that does not occur
  bool (*is_there)(const Cables& cables);
  void (*put)(Cables& cables, bool there);
};

constexpr std::string_view kSimplest = "nothing changes without it",
                           kNotInPaper = "the paper has none";
constexpr auto kNever = [](const Cables&) { return false; };
constexpr auto kAlways = [](const Cables&) { return true; };

std::span<const Term> Terms() {
  static constexpr Term kTerms[] = {
      {"contact", "no contact", "", "it is what the claim is of", "", kAlways,
       [](Cables& c, bool) { c.k = 0; }},
      {"stretch", "no springs", "", "they pull the cables against each other", "", kAlways,
       [](Cables& c, bool) { c.stretch = 0; }},
      {"both_free", "the lower bundle rigid", "", "the paper pulls both", "", kAlways,
       [](Cables& c, bool) { c.b_is_fixed = true; }},
      {"pre_tension", "springs at rest at the start", "springs 0.9 as long at rest",
       "the claim shows only under tension", kSimplest, [](const Cables& c) { return c.rest < 1; },
       [](Cables& c, bool there) { c.rest = there ? 0.9 : 1; }},
      {"side_memory", "no memory of sides", "the scene remembers sides",
       "without it nothing is ever penetrating", kSimplest,
       [](const Cables& c) { return c.memory != Memory::kNone; },
       [](Cables& c, bool there) { c.memory = there ? Memory::kScene : Memory::kNone; }},
      {"pair_memory", "", "each pair remembers its side", "", "the scene's memory is simpler",
       kNever, [](Cables& c, bool) { c.memory = Memory::kPair; }},
      {"damping", "no Rayleigh damping", "Rayleigh damping of 0.006 s, the paper's",
       "small steps ring without it", kSimplest, [](const Cables& c) { return c.rayleigh > 0; },
       [](Cables& c, bool there) { c.rayleigh = there ? 0.006 : 0; }},
      {"more_damping", "", "Rayleigh damping of 0.05 s", "", "the paper has 0.006 s", kNever,
       [](Cables& c, bool) { c.rayleigh = 0.05; }},
      {"noise", "no noise of the vertices", "noise of the vertices, 1 mm", "", kSimplest,
       [](const Cables& c) { return c.noise > 0; },
       [](Cables& c, bool there) { c.noise = there ? 1e-3 : 0; }},
      {"gravity", "", "gravity of 9.81 m/s^2, the paper's", "", kSimplest, kNever,
       [](Cables& c, bool) { c.gravity = 9.81; }},
      // The paper's 10^4 Pa in a rod 2.7 cm thick have about so much between segments of 0.4 m.
      {"bending", "", "bending, 0.01 J", "", kSimplest, kNever,
       [](Cables& c, bool) { c.bending = 0.001; }},
      {"stiff_bending", "", "bending, 1 J", "", "it changes the statics", kNever,
       [](Cables& c, bool) { c.bending = 0.1; }},
      {"mass_spread", "", "masses spread by a factor e", "", kSimplest, kNever,
       [](Cables& c, bool) { c.mass_spread = 1; }},
      {"cg", "", "conjugate gradients in place of LDLT", "", "pivots count negative eigenvalues",
       kNever, [](Cables& c, bool) { c.solver = Solver::kConjugateGradients; }},
      {"newton", "", "5 iterations of Newton's method", "", "the paper solves once a step", kNever,
       [](Cables& c, bool) { c.iterations = 5; }},
      {"line_search", "", "20 iterations of Newton's method with a line search", "", kNotInPaper,
       kNever,
       [](Cables& c, bool) {
         c.iterations = 20;
         c.line_search = true;
       }},
      {"within", "", "contacts within bundles", "", kSimplest,
       [](const Cables& c) { return c.within_bundles; },
       [](Cables& c, bool there) { c.within_bundles = there; }},
  };
  return kTerms;
}

}  // namespace

std::vector<Change> ChangesOf(const Cables& cables) {
  std::vector<Change> changes;
  for (const Term& term : Terms()) {
    if (term.name == "within" && cables.each == 1) continue;
    const bool there = term.is_there(cables);
    changes.push_back({term.name, there ? term.without : term.with, there,
                       there ? term.why_has : term.why_lacks});
  }
  return changes;
}

Trial MakeCables(Cables cables, const Case& c, Draws& draws) {
  const double k = cables.k;  // masses and springs stay as they are without contact
  if (!c.change.empty()) {
    const auto at = std::ranges::find(Terms(), c.change, &Term::name);
    if (at == Terms().end()) throw std::runtime_error(fmt::format("no change '{}'", c.change));
    at->put(cables, !at->is_there(cables));
  }
  const double mass = kFrame * kFrame * k / c.mu;
  Trial trial;
  Model& model = trial.model;
  model.script_end = kMoveSeconds;
  Contacts& contacts = model.contacts;
  contacts.stencil = "edge_edge";
  contacts.length = c.length;
  contacts.eps = cables.eps;
  contacts.memory = cables.memory;

  const double turn = Symmetric(draws, cables.yaw);
  const Point u = {std::cos(turn), std::sin(turn), 0}, up = {0, 0, 1};
  const Point across = {-u[1], u[0], 0};
  std::vector<int> first[2];
  for (int bundle = 0; bundle < 2; ++bundle) {
    const Point along = bundle == 0 ? u : Point{0, 1, 0};
    const Point sideways = bundle == 0 ? across : Point{1, 0, 0};
    const double z = (bundle == 0 ? 0.5 : -0.5) * cables.gap;
    const double shift = Symmetric(draws, cables.offset);
    const Point velocity = ((bundle == 0 ? -1 : 1) * cables.displacement / kMoveSeconds) * up;
    for (int i = 0; i < cables.each; ++i) {
      const double place = (i - 0.5 * (cables.each - 1)) * cables.spacing;
      const Point middle = (place + shift) * sideways + z * up;
      const Point half = cables.half_length * along;
      first[bundle].push_back(AddCable(cables, middle - half, middle + half, velocity, mass,
                                       bundle == 1 && cables.b_is_fixed, draws, model));
    }
  }
  // A above B: n = A x B points up, and n.e2 down.
  for (const int a : first[0]) {
    for (const int b : first[1]) AddPairs(cables.segments, a, b, -1, contacts);
  }
  if (cables.within_bundles) {
    for (const auto& bundle : first) {
      for (std::size_t i = 0; i < bundle.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          AddPairs(cables.segments, bundle[i], bundle[j], 0, contacts);
        }
      }
    }
  }
  contacts.k = cables.k;
  if (cables.k == 0) contacts.vertices.clear(), contacts.orientation.clear(), contacts.k = k;

  Elements springs{"strand/stretch/quadratic", {}, {}}, bends{"strand/bend/quadratic", {}, {}};
  const double stiffness = cables.stretch * k * cables.segments / 3;
  const double rest = cables.rest * 2 * cables.half_length / cables.segments;
  for (const auto& bundle : first) {
    for (const int cable : bundle) {
      for (int i = 0; i < cables.segments; ++i) {
        springs.vertices.insert(springs.vertices.end(), {cable + i, cable + i + 1});
        springs.p.insert(springs.p.end(), {stiffness, rest});
        if (i == 0) continue;
        bends.vertices.insert(bends.vertices.end(), {cable + i - 1, cable + i, cable + i + 1});
        bends.p.insert(bends.p.end(), {cables.bending * k, 0.0});
      }
    }
  }
  if (cables.stretch > 0) model.elastic.push_back(springs);
  if (cables.bending > 0) model.elastic.push_back(bends);

  trial.method.filter = c.filter;
  trial.method.rayleigh = cables.rayleigh;
  trial.method.solver = cables.solver;
  trial.method.iterations = cables.iterations;
  trial.method.line_search = cables.line_search;
  trial.substeps = c.substeps;
  trial.frames = static_cast<int>(std::lround((kMoveSeconds + kHoldSeconds) / kFrame));
  trial.watch.span = 3 * cables.half_length;
  trial.watch.jitter_from = kMoveSeconds + 2 * kHoldSeconds / 3;
  trial.watch.crossings = true;
  if (cables.each > 1) {
    trial.watch.spacing_neighbours = cables.each;
    for (const auto& bundle : first) {
      for (const int cable : bundle) trial.watch.spacing.push_back(cable + cables.segments / 2);
    }
  }
  return trial;
}

}  // namespace definite::scenes
