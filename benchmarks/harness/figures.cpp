#include "benchmarks/harness/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/spectrum.hpp"

namespace definite {

namespace {

constexpr int kMaxRows = 12;

// sqrt(sum of squares of the full matrix) of the entries entry(k). Eight partial sums: one would
// wait for itself.
template <class Entry>
double PackedNorm(std::size_t size, int n, Entry entry) {
  double partial[8] = {};
  std::size_t k = 0;
  for (; k + 8 <= size; k += 8) {
    for (std::size_t i = 0; i < 8; ++i) partial[i] += entry(k + i) * entry(k + i);
  }
  for (; k < size; ++k) partial[0] += entry(k) * entry(k);
  double diagonal = 0;
  k = 0;
  for (int i = 0; i < n; ++i) {
    diagonal += entry(k) * entry(k);
    k += static_cast<std::size_t>(n - i);
  }
  const double sum = ((partial[0] + partial[1]) + (partial[2] + partial[3])) +
                     ((partial[4] + partial[5]) + (partial[6] + partial[7]));
  return std::sqrt(sum + (sum - diagonal));
}

}  // namespace

int PackedRows(Packed a) {
  int n = 0;
  while (n * (n + 1) / 2 < static_cast<int>(a.size())) ++n;
  return n;
}

double FrobeniusNorm(Packed a) {
  return PackedNorm(a.size(), PackedRows(a), [&](std::size_t k) { return a[k]; });
}

double FrobeniusDistance(Packed a, Packed b) {
  return PackedNorm(a.size(), PackedRows(a), [&](std::size_t k) { return a[k] - b[k]; });
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
  double m[kMaxRows][kMaxRows] = {};  // the upper triangle; rows of full length suit the machine
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) m[i][j] = a[k++];
    m[i][i] += kRatioBound * n * kUnit * norm;
  }
  for (int j = 0; j < n; ++j) {
    const double pivot = m[j][j];
    if (!(pivot > 0)) return false;
    for (int i = j + 1; i < n; ++i) {
      const double factor = m[j][i] / pivot;
      for (int c = 0; c < kMaxRows; ++c) m[i][c] -= factor * m[j][c];
    }
  }
  return true;
}

std::vector<double> Eigenvalues(Packed a) {
  const int n = PackedRows(a);
  reference::Matrix<double> upper(n, n);
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) upper(i, j) = a[k++];
  }
  return reference::EigenSpectrum(upper).values.entries;
}

std::vector<double> Difference(Packed a, Packed b) {
  std::vector<double> difference(a.size());
  std::ranges::transform(a, b, difference.begin(), std::minus<>());
  return difference;
}

}  // namespace definite
