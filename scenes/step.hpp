#pragma once

// One step of implicit integration.
//
// Source: Baraff & Witkin 1998: one linear solve with the Hessian at the beginning of the step,
// (M/dt^2 + C/dt + H) dx = M v/dt + f, no line search. Several iterations are Newton's method on
// backward Euler.

#include <optional>

#include "scenes/contact.hpp"

namespace definite::scenes {

enum class Solver { kLdlt, kConjugateGradients };

struct Method {
  // Of the contacts: a filter of the registry; "on_demand": none, and the fallback if a pivot is
  // negative; "progressive": (1-s) none + s fallback, s = 0, 1/4, ... 1, until no pivot is.
  std::string filter = "analytic";
  std::string fallback = "analytic";
  std::string elastic_filter = "analytic";  // of elastic terms
  double rayleigh = 0;                      // C = rayleigh H of the elastic terms, s
  Solver solver = Solver::kLdlt;
  int iterations = 1;
  bool line_search = false;
};

struct State {
  std::vector<double> x, v;
  double time = 0;
  SideMemory memory;
};

struct StepReport {
  int negative_pivots = 0;  // of the last matrix that was solved with
  int first_negative = 0;   // of the first, unfiltered where filters come on demand
  int factorizations = 0, solver_iterations = 0, newton_iterations = 0;
  bool solved = true;         // false: a singular matrix, or a result that is not finite
  bool converged = true;      // of Newton with a line search
  std::size_t contacts = 0;   // in reach at the beginning
  double kernel_seconds = 0;  // in rows of the registry
};

// Advances `state` by dt seconds.
StepReport Advance(const Model& model, const Method& method, double dt, State& state);

// The energy of all terms (J), its gradient over all coordinates, and its Hessian by filters,
// dense, row by row: for tests. Contacts as in reach at x.
struct Assembled {
  double value = 0;
  std::vector<double> gradient, hessian;
};
Assembled Assemble(const Model& model, const Method& method, const std::vector<double>& x,
                   SideMemory& memory);

// Whether a name can be Method::filter.
bool IsFilter(std::string_view name);

}  // namespace definite::scenes
