#include "benchmarks/harness/symmetries.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace definite {

namespace {

// Where entry (i, j) of n rows stands, in either order.
std::size_t PackedAt(int n, int i, int j) {
  if (i > j) std::swap(i, j);
  return static_cast<std::size_t>(i * n - i * (i - 1) / 2 + j - i);
}

Symmetry Unchanged(Property property, int n) {
  Symmetry same{property, {}, std::vector<double>(static_cast<std::size_t>(n), 1), 0};
  for (int i = 0; i < n; ++i) same.from.push_back(i);
  return same;
}

// Exact, as it is within the range of normal numbers; false beyond.
bool Scale(double value, int exponent, std::vector<double>& scaled) {
  scaled.push_back(std::ldexp(value, exponent));
  return value == 0 || exponent == 0 || std::isnormal(scaled.back());
}

}  // namespace

bool Symmetry::Apply(const EnergyRow& energy, const double* x, const double* p,
                     std::vector<double>& new_x, std::vector<double>& new_p) const {
  new_x.clear();
  new_p.clear();
  bool exact = true;
  for (std::size_t i = 0; i < from.size(); ++i) {
    exact = Scale(sign[i] * x[from[i]], exponent, new_x) && exact;
  }
  for (std::size_t j = 0; j < energy.parameters.size(); ++j) {
    exact = Scale(p[j], exponent * energy.parameters[j].length_power, new_p) && exact;
  }
  return exact;
}

std::vector<double> Symmetry::Expected(Packed f) const {
  const auto n = static_cast<int>(from.size());
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<double> expected;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) {
      expected.push_back(sign[at(i)] * sign[at(j)] * f[PackedAt(n, from[at(i)], from[at(j)])]);
    }
  }
  return expected;
}

std::vector<Symmetry> SymmetriesOf(const EnergyRow& energy) {
  const int n = energy.dofs, d = energy.dimension, vertices = n / d;
  std::vector<Symmetry> all;
  for (std::size_t first = 0; first < energy.relabellings.size();
       first += static_cast<std::size_t>(vertices)) {
    Symmetry turned = Unchanged(Property::kRelabelling, n);
    for (int i = 0; i < n; ++i) {
      turned.from[static_cast<std::size_t>(i)] =
          energy.relabellings[first + static_cast<std::size_t>(i / d)] * d + i % d;
    }
    all.push_back(turned);
  }
  // About the last axis, (x, y) to (-y, x); and in space the axes in turn.
  Symmetry quarter = Unchanged(Property::kRigidMotion, n), third = quarter;
  for (int i = 0; i < n; ++i) {
    const int k = i % d;
    const auto at = static_cast<std::size_t>(i);
    if (k < 2) quarter.from[at] = i - k + 1 - k;
    if (k == 0) quarter.sign[at] = -1;
    third.from[at] = i - k + (k + 1) % d;
  }
  all.push_back(quarter);
  if (d == 3) all.push_back(third);
  for (const int exponent : {-300, 300}) {
    Symmetry unit = Unchanged(Property::kScale, n);
    unit.exponent = exponent;
    all.push_back(unit);
  }
  return all;
}

double OnTranslations(const EnergyRow& energy, Packed f) {
  const int n = energy.dofs, d = energy.dimension;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < d; ++k) {
      double row = 0;
      for (int j = k; j < n; j += d) row += f[PackedAt(n, i, j)];
      sum += row * row;
    }
  }
  return std::sqrt(sum);
}

}  // namespace definite
