#include "benchmarks/newton/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace definite::newton {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A cubic by Horner's rule errs by less than this times the sum of its terms' magnitudes, the
// rounding of the coefficients included.
constexpr double kRounding = 32 * 0x1p-53;

double ValueOf(const std::array<double, 4>& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}
double MagnitudeOf(const std::array<double, 4>& c, double t) {
  return std::abs(c[0]) + t * (std::abs(c[1]) + t * (std::abs(c[2]) + t * std::abs(c[3])));
}

// Where the slope is 0, ascending; NaN for a root that there is not.
std::array<double, 2> ExtremaOf(const std::array<double, 4>& c) {
  const double a = 3 * c[3], half = c[2], discriminant = half * half - a * c[1];
  if (!(discriminant >= 0)) return {NAN, NAN};
  // The one that does not cancel first, and the other by their product.
  const double q = -(half + std::copysign(std::sqrt(discriminant), half));
  const double one = q / a, other = c[1] / q;
  return {std::fmin(one, other), std::fmax(one, other)};
}

// Of a function that falls from a positive value at `low` to 0 or less at `high`.
double Bisect(const std::array<double, 4>& c, double low, double high) {
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return low;
    (ValueOf(c, middle) > 0 ? low : high) = middle;
  }
}

// The determinant of the edges of an element along a step.
std::array<double, 4> DeterminantAlong(int d, const double* x, const double* step) {
  double edges[3][3], moved[3][3];
  for (int k = 0; k < d; ++k) {
    for (int i = 0; i < d; ++i) {
      edges[k][i] = x[(k + 1) * d + i] - x[i];
      moved[k][i] = step[(k + 1) * d + i] - step[i];
    }
  }
  if (d == 2) {
    const auto det = [](const double* a, const double* b) { return a[0] * b[1] - a[1] * b[0]; };
    return {det(edges[0], edges[1]), det(edges[0], moved[1]) + det(moved[0], edges[1]),
            det(moved[0], moved[1]), 0};
  }
  const auto det = [](const double* a, const double* b, const double* e) {
    return a[0] * (b[1] * e[2] - b[2] * e[1]) + a[1] * (b[2] * e[0] - b[0] * e[2]) +
           a[2] * (b[0] * e[1] - b[1] * e[0]);
  };
  const double *a = edges[0], *b = edges[1], *e = edges[2];
  const double *u = moved[0], *v = moved[1], *w = moved[2];
  return {det(a, b, e), det(u, b, e) + det(a, v, e) + det(a, b, w),
          det(a, v, w) + det(u, b, w) + det(u, v, e), det(u, v, w)};
}

}  // namespace

double FirstRoot(const std::array<double, 4>& c, double most) {
  double low = 0;
  const std::array<double, 2> extrema = ExtremaOf(c);
  for (const double end : {extrema[0], extrema[1], most}) {
    if (!(end > low && end <= most)) continue;
    const double value = ValueOf(c, end);
    if (value <= 0) return Bisect(c, low, end);
    if (value <= kRounding * MagnitudeOf(c, end)) return end;
    low = end;
  }
  return kInfinity;
}

double StepLimit(const Problem& problem, const std::vector<double>& x,
                 const std::vector<double>& step, double most) {
  const int d = problem.energy->dimension, size = problem.Size();
  double limit = most;
  for (int e = 0; e < problem.Elements(); ++e) {
    double own_x[12], own_step[12];
    for (int i = 0; i < size; ++i) {
      const int vertex = problem.elements[static_cast<std::size_t>(e * size + i)];
      for (int k = 0; k < d; ++k) {
        own_x[i * d + k] = x[static_cast<std::size_t>(vertex * d + k)];
        own_step[i * d + k] = step[static_cast<std::size_t>(vertex * d + k)];
      }
    }
    limit = std::min(limit, FirstRoot(DeterminantAlong(d, own_x, own_step), limit));
  }
  return limit;
}

}  // namespace definite::newton
