#include "benchmarks/harness/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "benchmarks/harness/sampling/random.hpp"

namespace definite {

namespace {

using reference::Quad;
using reference::Truth;

constexpr double kMoved = 8 * kUnit;  // of an edge, relative to its longest component
constexpr int kDirections = 8;        // each taken forwards and backwards

// Beside a border of the domain there is no telling what a neighbour gives.
double Finite(double change) {
  return std::isfinite(change) ? change : std::numeric_limits<double>::infinity();
}

template <class Matrix>
double Distance(const Matrix& a, const Matrix& b) {
  return Finite(static_cast<double>(reference::FrobeniusNorm(a - b)));
}

}  // namespace

Neighbours::Neighbours(const EnergyRow& energy, const reference::Energy<Quad>& definition,
                       const double* x, const double* p) {
  const int d = energy.dimension;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  const std::vector<Quad> quad_p(p, p + energy.parameters.size());
  const auto at = [d](int vertex, int k) { return static_cast<std::size_t>(vertex * d + k); };
  for (int direction = 0; direction < kDirections; ++direction) {
    for (const double sign : {1.0, -1.0}) {
      Draws draws(StreamId("neighbours"), 0, static_cast<std::uint64_t>(direction));
      std::vector<Quad> moved(x, x + energy.dofs);
      // Along the tree: moved edges give moved vertices.
      for (std::size_t e = 0; e < energy.tree.size(); e += 2) {
        const int from = energy.tree[e], to = energy.tree[e + 1];
        double length = 0;
        for (int k = 0; k < d; ++k) {
          length = std::max(length, std::abs(x[at(to, k)] - x[at(from, k)]));
        }
        longest = std::max(longest, length);
        if (length > 0) shortest = std::min(shortest, length);
        for (int k = 0; k < d; ++k) {
          const Quad edge = Quad(x[at(to, k)]) - Quad(x[at(from, k)]);
          moved[at(to, k)] = moved[at(from, k)] + edge +
                             Quad(sign * kMoved * (2 * draws.OpenUniform() - 1)) * Quad(length);
        }
      }
      truths_.emplace_back(definition, moved.data(), quad_p.data());
    }
  }
  lost_edge_ = shortest <= kMoved * longest;
}

double Neighbours::Change(const reference::Filter<Quad>& filter, Truth<Quad>& truth) {
  const auto [at, is_new] = changes_.try_emplace(&filter, 0);
  if (is_new) {
    const auto definition = filter.define(truth);
    for (Truth<Quad>& neighbour : truths_) {
      at->second = std::max(at->second, Distance(filter.define(neighbour), definition));
    }
    // Not one digit is left where a neighbour is half as large, or else: a step farther, and it may
    // be of any size. And beside an edge that is less than another's rounding, a foot point may be
    // anywhere, which few neighbours show.
    if (lost_edge_ || 2 * at->second >= static_cast<double>(reference::FrobeniusNorm(definition))) {
      at->second = std::numeric_limits<double>::infinity();
    }
  }
  return at->second;
}

double Neighbours::ValueChange(Truth<Quad>& truth) {
  double change = 0;
  for (Truth<Quad>& neighbour : truths_) {
    const auto difference = static_cast<double>(neighbour.Value() - truth.Value());
    change = std::max(change, Finite(std::abs(difference)));
  }
  return change;
}

double Neighbours::GradientChange(Truth<Quad>& truth) {
  double change = 0;
  for (Truth<Quad>& neighbour : truths_) {
    change = std::max(change, Distance(neighbour.Gradient(), truth.Gradient()));
  }
  return change;
}

}  // namespace definite
