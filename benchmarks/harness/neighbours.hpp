#pragma once

// What rounding does to a configuration, whatever computes with it: its neighbours, whose edges are
// a few units in the last place longer, shorter or turned. Where those differ a lot, no filter in
// double can be near the truth, and none is held to it (docs/protocol.md, section 1, "inherent").

#include <deque>
#include <map>
#include <span>

#include "benchmarks/harness/figures.hpp"
#include "kernels/kernel.hpp"
#include "reference/oracle.hpp"

namespace definite {

// Of one configuration; what is asked is computed once. Not thread safe.
class Neighbours {
 public:
  Neighbours(const EnergyRow& energy, const reference::Energy<reference::Quad>& definition,
             const double* x, const double* p);

  // The largest change of a filter's definition from the truth to a neighbour, in the Frobenius
  // norm; infinite if that is as large as the definition itself, or if rounding of one edge is as
  // long as another.
  double Change(const reference::Filter<reference::Quad>& filter,
                reference::Truth<reference::Quad>& truth);
  // The same of the value and of the gradient (Euclidean).
  double ValueChange(reference::Truth<reference::Quad>& truth);
  double GradientChange(reference::Truth<reference::Quad>& truth);

 private:
  bool lost_edge_ = false;
  std::deque<reference::Truth<reference::Quad>> truths_;
  std::map<const void*, double> changes_;
};

}  // namespace definite
