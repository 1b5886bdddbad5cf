#include "scenes/cables.hpp"

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

}  // namespace

std::span<const CableChange> CableChanges() {
  static constexpr CableChange kChanges[] = {
      {{"contact", "no contact", true, "it is what the claim is of"}, [](Cables& c) { c.k = 0; }},
      {{"stretch", "no springs", true, "they pull the cables against each other"},
       [](Cables& c) { c.stretch = 0; }},
      {{"pre_tension", "springs at rest at the start", true, "it keeps springs from compression"},
       [](Cables& c) { c.rest = 1; }},
      {{"side_memory", "no memory of sides", true, "without it nothing is ever penetrating"},
       [](Cables& c) { c.memory = Memory::kNone; }},
      {{"scene_memory", "a memory for each pair in place of the scene's", true, "the simplest"},
       [](Cables& c) { c.memory = Memory::kPair; }},
      {{"damping", "no Rayleigh damping", true, "the paper has it"},
       [](Cables& c) { c.rayleigh = 0; }},
      {{"noise", "no noise of the vertices", true, "it makes starts differ"},
       [](Cables& c) { c.noise = 0; }},
      {{"both_free", "the lower bundle fixed", true, "the paper pulls both"},
       [](Cables& c) { c.b_is_fixed = true; }},
      {{"gravity", "gravity of 9.81 m/s^2", false, "the ends do the pulling"},
       [](Cables& c) { c.gravity = 9.81; }},
      {{"bending", "bending, 0.1 k", false, "the paper's strands have it; it changes the statics"},
       [](Cables& c) { c.bending = 0.1; }},
      {{"mass_spread", "masses spread by a factor e", false, "equal masses are simpler"},
       [](Cables& c) { c.mass_spread = 1; }},
      {{"more_damping", "Rayleigh damping of 0.05 s", false, "the paper has 0.006 s"},
       [](Cables& c) { c.rayleigh = 0.05; }},
      {{"cg", "conjugate gradients in place of LDLT", false, "pivots count negative eigenvalues"},
       [](Cables& c) { c.solver = Solver::kConjugateGradients; }},
      {{"newton", "5 iterations of Newton's method", false, "the paper solves once a step"},
       [](Cables& c) { c.iterations = 5; }},
      {{"line_search", "20 iterations of Newton's method with a line search", false,
        "the paper has none"},
       [](Cables& c) {
         c.iterations = 20;
         c.line_search = true;
       }},
      {{"within", "contacts within bundles", false, "the claim is of the crossings"},
       [](Cables& c) { c.within_bundles = true; }},
  };
  return kChanges;
}

std::vector<Change> ChangesOf(std::span<const std::pair<std::string_view, std::string_view>> why) {
  std::vector<Change> changes;
  for (const CableChange& c : CableChanges()) {
    if (c.change.name == "within") continue;  // of bundles alone
    changes.push_back(c.change);
    for (const auto& [name, reason] : why) {
      if (name == c.change.name) changes.back().why = reason;
    }
  }
  return changes;
}

Trial MakeCables(Cables cables, const Case& c, Draws& draws) {
  const double k = cables.k;  // masses and springs stay as they are without contact
  if (!c.change.empty()) {
    const auto at = std::ranges::find(CableChanges(), c.change,
                                      [](const CableChange& x) { return x.change.name; });
    if (at == CableChanges().end()) throw std::runtime_error("no change '" + c.change + "'");
    at->apply(cables);
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
