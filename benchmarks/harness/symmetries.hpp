#pragma once

// What a configuration may be turned into without any rounding, and what a filter then has to give:
// the vertices numbered otherwise, turns by a right angle, lengths in units of a power of two.

#include <vector>

#include "benchmarks/harness/figures.hpp"
#include "kernels/kernel.hpp"

namespace definite {

struct Symmetry {
  Property property;      // the promise that it is about
  std::vector<int> from;  // x'[i] = sign[i] 2^exponent x[from[i]], and F' alike without the unit
  std::vector<double> sign;
  int exponent;

  // False if a number would leave the range of doubles.
  bool Apply(const EnergyRow& energy, const double* x, const double* p, std::vector<double>& new_x,
             std::vector<double>& new_p) const;
  // The F' of F.
  std::vector<double> Expected(Packed f) const;
};

// All that its stencil has.
std::vector<Symmetry> SymmetriesOf(const EnergyRow& energy);

// The norm of F's action on translations, which is 0.
double OnTranslations(const EnergyRow& energy, Packed f);

}  // namespace definite
