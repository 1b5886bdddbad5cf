#pragma once

// What Newton's method asks of a problem: value, gradient, and a Hessian as any filter has it.

#include <Eigen/Sparse>
#include <vector>

#include "benchmarks/newton/problem.hpp"
#include "kernels/core/aligned_doubles.hpp"

namespace definite::newton {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;  // the lower triangle of a symmetric one

// The energy term by term: a difference of two, summed term by term, keeps the digits that the
// difference of two sums would lose.
struct Terms {
  std::vector<double> of;
  bool in_domain = true;

  double Sum() const;
  double LessThose(const Terms& before) const;  // the sum of differences
};

// Of a static problem; or of a step of time, once SetInertia was called.
class Objective {
 public:
  explicit Objective(const Problem& problem);

  // weight/2 |x - predicted|^2 is added; both of each coordinate.
  void SetInertia(std::vector<double> weight, std::vector<double> predicted);

  int Free() const { return free_; }  // degrees of freedom
  // The free coordinates among all, in order.
  const std::vector<int>& FreeCoordinates() const { return coordinates_; }
  // Of a coordinate among the free ones; -1 if it is fixed.
  int NumberOf(int coordinate) const { return number_[static_cast<std::size_t>(coordinate)]; }
  const std::vector<double>& InertiaWeight() const { return weight_; }

  Terms ValueAt(const std::vector<double>& x) const;
  // Over free coordinates.
  Vector GradientAt(const std::vector<double>& x) const;

  // The greatest force on a free vertex if all its elements pulled with a stress that is their
  // first stiffness: what gradients are small against.
  double CharacteristicForce() const;

  const Problem& Of() const { return problem_; }

 private:
  std::vector<double> Gather(const std::vector<double>& x) const;

  const Problem& problem_;
  std::vector<int> number_, coordinates_;
  int free_ = 0;
  std::vector<double> weight_, predicted_;  // empty without inertia
};

// The Hessian of an objective by one row of the registry. Pattern and places are found once.
class Hessian {
 public:
  Hessian(const Objective& objective, const KernelRow& row);

  // Two stages, for a clock between them: matrices of all elements, then their sum.
  void Evaluate(const std::vector<double>& x);
  void Assemble();

  const Matrix& Sum() const { return matrix_; }

 private:
  // fill(element, first configuration of its tile, lane) for all that tiles hold.
  template <class Fill>
  void ForTiles(Fill fill) const;
  double Entry(long element, int k) const {
    const long lanes = row_.lanes;
    return packed_.Data()[(element / lanes * row_.outputs + k) * lanes + element % lanes];
  }

  const Objective& objective_;
  const Problem& problem_;
  const KernelRow& row_;
  const long tiles_;
  AlignedDoubles x_, p_, packed_;
  Matrix matrix_;
  std::vector<long> places_;    // in the values of the matrix, for each packed entry; -1 if fixed
  std::vector<long> diagonal_;  // of each free coordinate
};

}  // namespace definite::newton
