#pragma once

// One symmetric system after another, all of one pattern.

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <variant>

#include "benchmarks/newton/objective.hpp"
#include "benchmarks/newton/solver.hpp"

namespace definite::newton {

class LinearSystem {
 public:
  LinearSystem(LinearSolver solver, const Matrix& pattern);

  struct Answer {
    Vector x;             // empty where there is no factorisation, or it is not finite
    int negative_pivots;  // 0 with conjugate gradients
    long iterations;      // 0 with a factorisation
  };
  Answer Solve(const Matrix& a, const Vector& b);

 private:
  using Ldlt = Eigen::SimplicialLDLT<Matrix, Eigen::Lower>;
  using Cg = Eigen::ConjugateGradient<Matrix, Eigen::Lower>;  // with the diagonal to precondition

  std::variant<Ldlt, Cg> solver_;
};

// How many eigenvalues are negative: pivots that are, but for those that rounding makes of 0. All
// of them if there is no factorisation.
int CountNegative(const Matrix& a);

}  // namespace definite::newton
