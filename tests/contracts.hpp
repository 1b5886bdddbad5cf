#pragma once

// The contract suite: each property that a filter may promise, as a check on one row at one
// configuration. A check gives the size of the violation in units of its bound: above 1 the
// property does not hold.

#include <span>
#include <string>
#include <vector>

#include "kernels/kernel.hpp"

namespace definite::testing {

struct Configuration {
  std::string name;
  std::vector<double> x, p;
  bool well_conditioned;
  double conditioning;  // as docs/protocol.md, section 1, has it for the family
};

// What a check works on. `exact` and `scalar` are the rows none/f64 and, for lanes, the scalar row
// of the same filter.
struct Subject {
  const KernelRow* row;
  const KernelRow* exact;
  const KernelRow* scalar;
};

// Larger than 1 where the property is violated; NaN counts as infinite. Accuracy needs a definition
// in reference/.
double Violation(Property property, const Subject& subject, const Configuration& configuration);

// The same of kAccurate, for rows of one energy: they share the Hessian in float128 and its
// spectrum, which take most of the time.
std::vector<double> AccuracyViolations(std::span<const KernelRow* const> rows,
                                       const Configuration& configuration);

// Configurations of an energy in its domain: drawn ones of every distribution, and degenerate ones
// for the families that have some.
std::vector<Configuration> Configurations(const EnergyRow& energy);

std::vector<double> Outputs(const KernelRow& row, const std::vector<double>& x,
                            const std::vector<double>& p);

}  // namespace definite::testing
