#include "benchmarks/newton/linear.hpp"

namespace definite::newton {

namespace {

constexpr double kResidual = 1e-10;  // of conjugate gradients, relative to the right-hand side
constexpr double kZero = 1e-10;      // a pivot, relative to the largest

}  // namespace

LinearSystem::LinearSystem(LinearSolver solver, const Matrix& pattern) {
  if (solver == LinearSolver::kLdlt) {
    std::get<Ldlt>(solver_).analyzePattern(pattern);
  } else {
    solver_.emplace<Cg>().setTolerance(kResidual);
  }
}

LinearSystem::Answer LinearSystem::Solve(const Matrix& a, const Vector& b) {
  Answer answer{{}, 0, 0};
  if (auto* const ldlt = std::get_if<Ldlt>(&solver_)) {
    ldlt->factorize(a);
    if (ldlt->info() != Eigen::Success) return answer;
    answer.negative_pivots = static_cast<int>((ldlt->vectorD().array() < 0).count());
    answer.x = ldlt->solve(b);
  } else {
    Cg& cg = std::get<Cg>(solver_);
    cg.compute(a);
    answer.x = cg.solve(b);
    answer.iterations = cg.iterations();
  }
  if (!answer.x.allFinite()) answer.x.resize(0);
  return answer;
}

int CountNegative(const Matrix& a) {
  const Eigen::SimplicialLDLT<Matrix, Eigen::Lower> ldlt(a);
  if (ldlt.info() != Eigen::Success) return static_cast<int>(a.rows());
  const Eigen::ArrayXd pivots = ldlt.vectorD();
  return static_cast<int>((pivots < -kZero * pivots.abs().maxCoeff()).count());
}

}  // namespace definite::newton
