#pragma once

// How far a step may go before an element inverts.
//
// Source: Smith and Schaefer 2015, "Bijective parameterization with free boundaries", section 3.3.

#include <array>
#include <vector>

#include "benchmarks/newton/problem.hpp"

namespace definite::newton {

// A point in (0, most] before which c[0] + c[1] t + c[2] t^2 + c[3] t^3, with c[0] > 0, is positive
// and behind which it is 0 or negative, by less than a step in the last place of `most`; infinity
// if there is none. A minimum that rounding cannot tell from 0 counts as one.
double FirstRoot(const std::array<double, 4>& c, double most);

// The greatest t, at most `most`, so that no element of x + s step inverts for 0 <= s <= t; x has
// none that is inverted, `step` is over all coordinates.
double StepLimit(const Problem& problem, const std::vector<double>& x,
                 const std::vector<double>& step, double most);

}  // namespace definite::newton
