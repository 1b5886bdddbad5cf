#pragma once

// Newton's method with a line search, by any Hessian of the registry.
//
// Source: Smith, de Goes and Kim 2019, Algorithm 1 and section 6; steps that keep elements from
// inverting after Smith and Schaefer 2015.
// Differs: gradients are held against a force of the problem's own instead of 1e-4; the decrease is
// Armijo's.

#include <string_view>
#include <vector>

#include "benchmarks/newton/problem.hpp"

namespace definite::newton {

enum class LinearSolver { kLdlt, kConjugateGradients };

struct Settings {
  // Of the largest entry of the gradient over the characteristic force (objective.hpp); descending.
  std::vector<double> tolerances = {1e-4, 1e-8};
  int most_iterations = 1000;
  LinearSolver solver = LinearSolver::kLdlt;
};

enum class Outcome {
  kConverged,
  kNotDescending,     // the energy does not fall along the step
  kSingular,          // the matrix has no factorisation, or the step is not finite
  kLineSearchFailed,  // no step length brings a decrease
  kIterationLimit,
  kInterrupted,
};
std::string_view NameOf(Outcome outcome);

struct Iteration {
  double value, gradient;  // before the step; the gradient over the characteristic force
  double step;             // the share of Newton's step that was taken
  int negative_pivots;     // of the factorisation
};

// Of each stage. Pattern and ordering of the matrix, found once, are left out.
struct Seconds {
  double hessians = 0, assembly = 0, solution = 0, line_search = 0, gradients = 0;

  double Sum() const { return hessians + assembly + solution + line_search + gradients; }
};

// What it took until the gradient first met a tolerance, summed over all steps of time.
struct Reached {
  double tolerance;
  int iterations;
  double seconds;
};

struct Descent {
  Outcome outcome = Outcome::kConverged;  // else it is the last step of time
  std::vector<Iteration> iterations;
  int factorizations = 0, evaluations = 0;  // of the energy in line searches
  int indefinite = 0;                       // factorisations with a negative pivot
  long solver_iterations = 0;               // of conjugate gradients
  double value = 0, gradient = 0;           // at the end, as in Iteration
  int falling = 0;                          // directions in which the exact Hessian falls there
  std::vector<Reached> reached;
  Seconds seconds;
  std::vector<double> x;
};

// The same bits whenever it runs on one machine, but for seconds. Throws std::invalid_argument
// where the start is outside the energy's domain.
Descent Solve(const Problem& problem, const KernelRow& row, const Settings& settings);

}  // namespace definite::newton
