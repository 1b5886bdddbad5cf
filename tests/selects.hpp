#pragma once

// Which way the Selects of an energy's kernels go, for the test that both ways are reached.

#include <concepts>

#include "kernels/core/counting.hpp"
#include "kernels/filters/absolute.hpp"
#include "kernels/filters/analytic.hpp"
#include "kernels/filters/blend.hpp"
#include "kernels/filters/gauss_newton.hpp"
#include "kernels/filters/nearest.hpp"
#include "kernels/filters/none.hpp"
#include "kernels/filters/split.hpp"

namespace definite::testing {

// An energy's value, gradient, classification and closed-form filters at (x, p), in scalar layout.
struct Traced {
  std::string energy;
  void (*run)(const double* x, const double* p);
};
std::vector<Traced> AllTraced();  // CMake writes it

template <class E, class F>
void TraceFilter(const Vec<Counting, E::kDofs>& x, const Vec<Counting, E::kParams>& p) {
  if constexpr (FilterOver<F, E, Counting>) ToPacked(F::template Apply<E>(x, p));
}

template <class E>
Traced Trace() {
  return {E::Name(), [](const double* x, const double* p) {
            Vec<Counting, E::kDofs> xs;
            Vec<Counting, E::kParams> ps;
            for (int i = 0; i < E::kDofs; ++i) xs[i] = Counting(x[i]);
            for (int i = 0; i < E::kParams; ++i) ps[i] = Counting(p[i]);
            E::Value(xs, ps);
            E::Gradient(xs, ps);
            E::Classify(xs, ps);
            TraceFilter<E, None>(xs, ps);
            TraceFilter<E, GaussNewton>(xs, ps);
            TraceFilter<E, Analytic>(xs, ps);
            TraceFilter<E, Split>(xs, ps);
            TraceFilter<E, Nearest>(xs, ps);
            TraceFilter<E, Absolute>(xs, ps);
            TraceFilter<E, BlendHalf>(xs, ps);
          }};
}

}  // namespace definite::testing
