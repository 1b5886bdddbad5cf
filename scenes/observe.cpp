#include "scenes/observe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/harness/clock.hpp"

namespace definite::scenes {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr FigureInfo kInfo[kFigures] = {
    {"fails", true, "what the scene calls failing"},
    {"booms", true, "a vertex leaves the scene, or a matrix is singular"},
    {"pops", true, "at the end one is through the other by more than 2 eps"},
    {"penetrates", true, "at the end one is through the other by at most 2 eps"},
    {"jitters", true, "jitter above 0.02 (30 dt)^2"},
    {"indefinite", true, "some matrix had a negative pivot"},
    {"energy", false, "greatest kinetic energy over k eps^2"},
    {"jitter", false, "RMS second difference of positions at the end over eps"},
    {"slip", false, "slip of the last step over u tan(theta)"},
    {"slide", false, "way slid over that without drag"},
    {"spacing", false, "mean distance of neighbours in a bundle at frame 45, m"},
    {"peak", false, "mu of the resonance over u/(eps - u)"},
    {"negative_pivots", false, "negative pivots for each step"},
    {"contacts", false, "pairs in reach for each step"},
    {"factorizations", false, "for each step"},
    {"cg_iterations", false, "for each step"},
};

double KineticEnergy(const Model& model, const State& state) {
  double energy = 0;
  for (std::size_t i = 0; i < state.v.size(); ++i) {
    if (!model.scripted[i / 3]) energy += model.mass[i / 3] * state.v[i] * state.v[i] / 2;
  }
  return energy;
}

bool IsOutside(const State& state, double span) {
  return std::ranges::any_of(state.x, [&](double x) { return !(std::abs(x) <= span); });
}

// Of the vertical gaps, negative where one is through the other, the least; NaN without a crossing.
double LeastGap(const Contacts& contacts, const std::vector<double>& x) {
  double least = kNone;
  for (std::size_t i = 0; i < contacts.Size(); ++i) {
    const int* v = &contacts.vertices[4 * i];
    double a, b;
    if (contacts.orientation[i] == 0 || !CrossFromAbove(x, v, a, b)) continue;
    const Point p = (1 - a) * At(x, v[0]) + a * At(x, v[1]);
    const Point q = (1 - b) * At(x, v[2]) + b * At(x, v[3]);
    // Which is above follows from the orientation and from how the edges cross.
    const Point n = Cross(At(x, v[1]) - At(x, v[0]), At(x, v[3]) - At(x, v[2]));
    const double gap = contacts.orientation[i] * (n[2] < 0 ? -1 : 1) * (q[2] - p[2]);
    if (!(gap >= least)) least = gap;
  }
  return least;
}

double Spacing(const Watch& watch, const std::vector<double>& x) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i + 1 < watch.spacing.size(); ++i) {
    if ((i + 1) % static_cast<std::size_t>(watch.spacing_neighbours) == 0) continue;
    const Point d = At(x, watch.spacing[i + 1]) - At(x, watch.spacing[i]);
    sum += std::sqrt(Dot(d, d));
    ++count;
  }
  return sum / count;
}

double Along(const Watch& watch, const std::vector<double>& x) {
  double sum = 0;
  for (const int v : watch.sliders) sum += Dot(At(x, v), watch.downhill);
  return sum / static_cast<double>(watch.sliders.size());
}

}  // namespace

const FigureInfo& InfoOf(Figure figure) { return kInfo[static_cast<std::size_t>(figure)]; }

Outcome::Outcome() { of.fill(kNone); }

Outcome Observe(const Trial& trial, Recorder* recorder) {
  const Model& model = trial.model;
  const Watch& watch = trial.watch;
  const Contacts& contacts = model.contacts;
  const double dt = trial.Dt(), start = WallSeconds();
  State state{model.x, model.v, 0, {}};
  std::vector<double> earlier = state.x, earliest = state.x;
  double kinetic = 0, squares = 0, kernel_seconds = 0;
  long differences = 0, pivots = 0, pairs = 0, solves = 0, iterations = 0;
  bool booms = false, indefinite = false;
  Outcome outcome;
  int step = 0;
  const int steps = trial.frames * trial.substeps;
  for (; step < steps && !booms; ++step) {
    const StepReport report = Advance(model, trial.method, dt, state);
    kernel_seconds += report.kernel_seconds;
    pivots += report.negative_pivots;
    pairs += static_cast<long>(report.contacts);
    solves += report.factorizations;
    iterations += report.solver_iterations;
    indefinite = indefinite || report.negative_pivots > 0;
    booms = !report.solved || (watch.span > 0 && IsOutside(state, watch.span));
    if (booms) break;
    kinetic = std::max(kinetic, KineticEnergy(model, state));
    if (step > 0 && state.time > watch.jitter_from) {
      for (std::size_t i = 0; i < state.x.size(); ++i) {
        if (model.scripted[i / 3]) continue;
        const double second = state.x[i] - 2 * earlier[i] + earliest[i];
        squares += second * second;
      }
      differences +=
          static_cast<long>(state.x.size() / 3) - std::ranges::count(model.scripted, true);
    }
    if (recorder) {
      SideMemory memory = state.memory;
      const Elements met = ContactsAt(contacts, state.x, memory);
      for (std::size_t i = 0; i < met.vertices.size(); ++i) {
        const Point at = At(state.x, met.vertices[i]);
        recorder->x.insert(recorder->x.end(), at.begin(), at.end());
        if (i % 4 == 0) recorder->side.push_back(met.p[3 * (i / 4) + 2]);
      }
    }
    if (!watch.spacing.empty() && step + 1 == 45 * trial.substeps) {
      outcome[Figure::kSpacing] = Spacing(watch, state.x);
    }
    earliest = earlier;
    earlier = state.x;
  }
  const double done = std::min(step + 1, steps), seconds = WallSeconds() - start;
  outcome[Figure::kBooms] = booms;
  outcome[Figure::kIndefinite] = indefinite;
  outcome[Figure::kPivots] = static_cast<double>(pivots) / done;
  outcome[Figure::kContacts] = static_cast<double>(pairs) / done;
  outcome[Figure::kSolves] = static_cast<double>(solves) / done;
  outcome[Figure::kIterations] = static_cast<double>(iterations) / done;
  outcome[Figure::kEnergy] = kinetic / (contacts.k * contacts.eps * contacts.eps);
  if (differences > 0 && !booms) {
    const double jitter = std::sqrt(squares / static_cast<double>(differences)) / contacts.eps;
    outcome[Figure::kJitter] = jitter;
    outcome[Figure::kJitters] = jitter > kJitterThreshold * (dt / kFrame) * (dt / kFrame);
  }
  if (watch.crossings && !booms) {
    const double gap = LeastGap(contacts, state.x);
    // Cables that no longer cross have lost each other.
    outcome[Figure::kBooms] = std::isnan(gap);
    outcome[Figure::kPops] = gap < -2 * contacts.eps;
    outcome[Figure::kPenetrates] = gap < 0 && gap >= -2 * contacts.eps;
  } else if (watch.crossings) {
    outcome[Figure::kPops] = outcome[Figure::kPenetrates] = 0;
  }
  if (watch.jitter_from > 0 && booms) outcome[Figure::kJitters] = 0;
  if (!watch.sliders.empty() && !booms) {
    const double now = Along(watch, state.x);
    // `earlier` is now; before it comes `earliest`.
    if (watch.expected_slip > 0) {
      outcome[Figure::kSlip] = (now - Along(watch, earliest)) / watch.expected_slip;
    }
    if (watch.free_slide > 0) {
      outcome[Figure::kSlide] = (now - Along(watch, model.x)) / watch.free_slide;
    }
  }
  outcome.kernel_share = kernel_seconds / seconds;
  outcome.step_seconds = seconds / done;
  return outcome;
}

}  // namespace definite::scenes
