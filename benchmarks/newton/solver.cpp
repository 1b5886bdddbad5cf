#include "benchmarks/newton/solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/progress.hpp"
#include "benchmarks/newton/linear.hpp"
#include "benchmarks/newton/objective.hpp"
#include "benchmarks/newton/step_limit.hpp"

namespace definite::newton {

namespace {

constexpr double kArmijo = 1e-4;       // the share of the predicted decrease that a step must bring
constexpr double kOfLimit = 0.9;       // of the way to the first inversion
constexpr double kShortest = 0x1p-40;  // step that is tried
constexpr double kNoise = 16 * 0x1p-53;  // of an energy, relative: no decrease below it can be told

// Adds the seconds that it lives.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(WallSeconds()) {}
  ~Stopwatch() { seconds_ += WallSeconds() - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  const double start_;
};

class Newton {
 public:
  Newton(const Problem& problem, const KernelRow& row, const Settings& settings)
      : problem_(problem),
        settings_(settings),
        objective_(problem),
        hessian_(objective_, row),
        system_(settings.solver, hessian_.Sum()),
        force_(objective_.CharacteristicForce()) {
    run_.x = problem.start;
    for (const double tolerance : settings.tolerances) run_.reached.push_back({tolerance, 0, 0});
  }

  Descent Solve() {
    if (problem_.motion) {
      Move(*problem_.motion);
    } else {
      run_.outcome = Minimize();
    }
    run_.falling = CountFalling();
    return std::move(run_);
  }

 private:
  void Move(const Motion& motion) {
    const auto d = static_cast<std::size_t>(problem_.energy->dimension);
    std::vector<double> weight, velocity(run_.x.size());
    for (std::size_t i = 0; i < run_.x.size(); ++i) {
      weight.push_back(motion.mass[i / d] / (motion.dt * motion.dt));
    }
    for (int step = 0; step < motion.steps; ++step) {
      const std::vector<double> before = run_.x;
      std::vector<double> predicted = before;
      for (std::size_t i = 0; i < before.size(); ++i) {
        predicted[i] += motion.dt * (velocity[i] + motion.dt * motion.gravity[i % d]);
      }
      objective_.SetInertia(weight, std::move(predicted));
      run_.outcome = Minimize();
      if (run_.outcome != Outcome::kConverged) {
        // The steps that are left have met nothing.
        if (step + 1 < motion.steps) run_.reached.clear();
        return;
      }
      for (std::size_t i = 0; i < before.size(); ++i) {
        velocity[i] = (run_.x[i] - before[i]) / motion.dt;
      }
    }
  }

  // From run_.x on. Tolerances that are not met are struck off what was reached.
  Outcome Minimize() {
    const double begin = run_.seconds.Sum();
    const std::size_t first = run_.iterations.size();
    terms_ = objective_.ValueAt(run_.x);
    if (!terms_.in_domain) {
      throw std::invalid_argument(problem_.name + ": its start is not in the energy's domain");
    }
    std::size_t met = 0;
    Outcome outcome = Outcome::kConverged;
    for (;;) {
      const Vector gradient = Gradient();
      run_.value = terms_.Sum();
      run_.gradient = gradient.lpNorm<Eigen::Infinity>() / force_;
      while (met < run_.reached.size() && run_.gradient <= run_.reached[met].tolerance) {
        run_.reached[met].iterations += static_cast<int>(run_.iterations.size() - first);
        run_.reached[met].seconds += run_.seconds.Sum() - begin;
        ++met;
      }
      if (run_.gradient <= settings_.tolerances.back()) break;
      if (run_.iterations.size() - first == static_cast<std::size_t>(settings_.most_iterations)) {
        outcome = Outcome::kIterationLimit;
        break;
      }
      outcome = Interrupted() ? Outcome::kInterrupted : Iterate(gradient);
      if (outcome != Outcome::kConverged) break;
    }
    run_.reached.resize(std::min(met, run_.reached.size()));
    return outcome;
  }

  // A gradient that is small is that of a saddle point, too.
  int CountFalling() const {
    Hessian exact(objective_, *FindKernel(problem_.energy->name + "/none/f64"));
    exact.Evaluate(run_.x);
    exact.Assemble();
    return CountNegative(exact.Sum());
  }

  // One step; kConverged if there is nothing wrong with it.
  Outcome Iterate(const Vector& gradient) {
    {
      const Stopwatch watch(run_.seconds.hessians);
      hessian_.Evaluate(run_.x);
    }
    {
      const Stopwatch watch(run_.seconds.assembly);
      hessian_.Assemble();
    }
    LinearSystem::Answer answer;
    {
      const Stopwatch watch(run_.seconds.solution);
      answer = system_.Solve(hessian_.Sum(), -gradient);
    }
    ++run_.factorizations;
    run_.indefinite += answer.negative_pivots > 0;
    run_.solver_iterations += answer.iterations;
    if (answer.x.size() == 0) return Outcome::kSingular;
    const double slope = gradient.dot(answer.x);
    if (!(slope < 0)) return Outcome::kNotDescending;
    const Stopwatch watch(run_.seconds.line_search);
    const double length = SearchLine(slope, answer.x);
    if (length == 0) return Outcome::kLineSearchFailed;
    run_.iterations.push_back({run_.value, run_.gradient, length, answer.negative_pivots});
    return Outcome::kConverged;
  }

  Vector Gradient() {
    const Stopwatch watch(run_.seconds.gradients);
    return objective_.GradientAt(run_.x);
  }

  // Goes along `free` and gives the share of it that was gone; 0 if no share brings a decrease.
  double SearchLine(double slope, const Vector& free) {
    std::vector<double> step(run_.x.size(), 0.0);
    for (int n = 0; n < objective_.Free(); ++n) {
      step[static_cast<std::size_t>(objective_.FreeCoordinates()[static_cast<std::size_t>(n)])] =
          free[n];
    }
    for (double length = LongestStep(step); length >= kShortest; length /= 2) {
      std::vector<double> trial = run_.x;
      for (std::size_t i = 0; i < trial.size(); ++i) trial[i] += length * step[i];
      Terms terms = objective_.ValueAt(trial);
      ++run_.evaluations;
      if (terms.in_domain &&
          terms.LessThose(terms_) <= kArmijo * length * slope + kNoise * std::abs(run_.value)) {
        run_.x = std::move(trial);
        terms_ = std::move(terms);
        return length;
      }
    }
    return 0;
  }

  double LongestStep(const std::vector<double>& step) const {
    // An energy has a mirror where it is not defined for inverted elements.
    if (problem_.energy->mirror.empty()) return 1;
    const double limit = StepLimit(problem_, run_.x, step, 1 / kOfLimit);
    return std::min(1.0, kOfLimit * limit);
  }

  const Problem& problem_;
  const Settings& settings_;
  Objective objective_;
  Hessian hessian_;
  LinearSystem system_;
  const double force_;
  Terms terms_;  // of the energy at run_.x
  Descent run_;
};

}  // namespace

std::string_view NameOf(Outcome outcome) {
  constexpr std::string_view kNames[] = {"converged",          "not_descending",  "singular",
                                         "line_search_failed", "iteration_limit", "interrupted"};
  return kNames[static_cast<int>(outcome)];
}

Descent Solve(const Problem& problem, const KernelRow& row, const Settings& settings) {
  return Newton(problem, row, settings).Solve();
}

}  // namespace definite::newton
