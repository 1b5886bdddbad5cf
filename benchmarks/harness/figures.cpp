#include "benchmarks/harness/figures.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace definite {

namespace {

constexpr int kMaxRows = 12;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxRows>;

// sqrt(sum of squares of the full matrix) of the entries entry(k).
template <class Entry>
double PackedNorm(int n, Entry entry) {
  double diagonal = 0, above = 0;
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    const double d = entry(k++);
    diagonal += d * d;
    for (int j = i + 1; j < n; ++j) {
      const double a = entry(k++);
      above += a * a;
    }
  }
  return std::sqrt(diagonal + 2 * above);
}

}  // namespace

int PackedRows(Packed a) {
  int n = 0;
  while (n * (n + 1) / 2 < static_cast<int>(a.size())) ++n;
  return n;
}

double FrobeniusNorm(Packed a) {
  return PackedNorm(PackedRows(a), [&](std::size_t k) { return a[k]; });
}

double FrobeniusDistance(Packed a, Packed b) {
  return PackedNorm(PackedRows(a), [&](std::size_t k) { return a[k] - b[k]; });
}

bool AllFinite(Packed a) {
  return std::ranges::all_of(a, [](double v) { return std::isfinite(v); });
}

bool AllZero(Packed a) {
  return std::ranges::all_of(a, [](double v) { return v == 0; });
}

double RelativeDistance(Packed a, Packed b) {
  const double distance = FrobeniusDistance(a, b);
  return distance == 0 ? 0 : distance / FrobeniusNorm(b);
}

bool IsPsd(Packed a) {
  const int n = PackedRows(a);
  const double norm = FrobeniusNorm(a);
  if (!(norm < std::numeric_limits<double>::infinity())) return false;
  if (norm == 0) return true;
  double m[kMaxRows][kMaxRows];
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) m[j][i] = a[k++];
    m[i][i] += kRatioBound * n * kUnit * norm;
  }
  for (int j = 0; j < n; ++j) {
    double pivot = m[j][j];
    for (int c = 0; c < j; ++c) pivot -= m[j][c] * m[j][c];
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot), inverse = 1 / root;
    m[j][j] = root;
    for (int i = j + 1; i < n; ++i) {
      double sum = m[i][j];
      for (int c = 0; c < j; ++c) sum -= m[i][c] * m[j][c];
      m[i][j] = sum * inverse;
    }
  }
  return true;
}

std::vector<double> Eigenvalues(Packed a) {
  const int n = PackedRows(a);
  Matrix full(n, n);
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) full(i, j) = full(j, i) = a[k++];
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(full, Eigen::EigenvaluesOnly);
  std::vector<double> values(static_cast<std::size_t>(n),
                             std::numeric_limits<double>::quiet_NaN());
  if (solver.info() == Eigen::Success) {
    std::copy_n(solver.eigenvalues().data(), n, values.begin());
  }
  return values;
}

std::vector<double> Difference(Packed a, Packed b) {
  std::vector<double> difference(a.size());
  std::ranges::transform(a, b, difference.begin(), std::minus<>());
  return difference;
}

}  // namespace definite
