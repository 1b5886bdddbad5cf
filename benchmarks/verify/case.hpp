#pragma once

// What a check works on: one configuration of an energy, with all that is known of it.

#include <map>
#include <string_view>
#include <vector>

#include "benchmarks/harness/figures.hpp"
#include "kernels/kernel.hpp"
#include "reference/oracle.hpp"

namespace definite::verify {

using reference::Quad;
using Matrix = reference::Matrix<Quad>;
using Numbers = std::vector<double>;

// An energy with rows of its own and its definition. The tests put broken ones in.
struct Subject {
  const EnergyRow* energy;
  std::vector<const KernelRow*> rows;  // those to be verified
  const reference::Energy<Quad>* reference;

  // The scalar row of a filter: one of `rows`, else of the registry; null if there is none.
  const KernelRow* Row(std::string_view filter) const;
};

// Throws std::runtime_error if reference/ does not define the energy or a filter.
Subject SubjectOf(const EnergyRow& energy, std::vector<const KernelRow*> rows);

// Whether one of the parts of a name between slashes is `part`.
bool HasPart(std::string_view name, std::string_view part);

// Not thread safe. Quantities are computed when asked for, the dear ones once.
class Case {
 public:
  Case(const Subject& subject, const double* x, const double* p);

  const Subject& Of() const { return subject_; }
  const EnergyRow& Energy() const { return *subject_.energy; }
  bool Is(std::string_view part) const { return HasPart(Energy().name, part); }
  const Numbers& X() const { return x_; }
  const Numbers& P() const { return p_; }

  // What the kernel says.
  bool Active() const { return Classified(x_)[0] == 1; }
  int Region() const { return static_cast<int>(Classified(x_)[2]); }
  // Whether x + s d lies where x does, for both signs of s: nothing jumps on the way.
  bool SameAround(const Numbers& d, double s) const;
  double Value() const { return ValueAt(x_); }
  Numbers Gradient() const { return GradientAt(x_); }
  double ValueAt(const Numbers& x) const;
  Numbers GradientAt(const Numbers& x) const;
  const Numbers& Output(const KernelRow& row);
  Matrix Hessian();  // the row none/f64

  // What holds.
  reference::Truth<Quad>& Truth() { return truth_; }
  const Matrix& Definition(std::string_view filter);
  double Length() const;  // infinite where psi is not a penalty of one
  double Conditioning() const { return conditioning_; }

  // An error in units of what rounding may do to a number of size `scale`, kRatioBound n u scale /
  // conditioning; 0/0 is 0. n is that of the energy unless given.
  double Ratio(const Quad& error, const Quad& scale, int n = 0) const;

 private:
  Numbers Classified(const Numbers& x) const;

  const Subject& subject_;
  Numbers x_, p_;
  reference::Truth<Quad> truth_;
  double conditioning_;
  std::map<const KernelRow*, Numbers> outputs_;
  std::map<std::string_view, Matrix> definitions_;
};

// The vector or packed matrix as a matrix over float128.
Matrix ToVector(const Numbers& v);
Matrix Unpacked(Packed a);
Numbers ToDouble(const Matrix& v);
Quad Dot(const Matrix& a, const Matrix& b);  // of the stored entries

}  // namespace definite::verify
