#include "benchmarks/harness/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/core/lanes.hpp"
#include "reference/spectrum.hpp"

namespace definite {

namespace {

constexpr int kMaxRows = 12;

// sqrt(sum of squares of the full matrix) of the entries entry(k). Eight partial sums: one would
// wait for itself.
template <class T, class Entry>
T PackedNorm(int n, Entry entry) {
  T partial[8];
  for (T& sum : partial) sum = T(0.0);
  const int size = n * (n + 1) / 2;
  int k = 0;
  for (; k + 8 <= size; k += 8) {
    for (int i = 0; i < 8; ++i) {
      const T a = entry(k + i);
      partial[i] = partial[i] + a * a;
    }
  }
  for (; k < size; ++k) partial[0] = partial[0] + entry(k) * entry(k);
  T diagonal(0.0);
  k = 0;
  for (int i = 0; i < n; ++i) {
    diagonal = diagonal + entry(k) * entry(k);
    k += n - i;
  }
  const T sum = ((partial[0] + partial[1]) + (partial[2] + partial[3])) +
                ((partial[4] + partial[5]) + (partial[6] + partial[7]));
  return Sqrt(sum + (sum - diagonal));
}

// 1 where lambda_min >= -kRatioBound n u norm, by the pivots of the shifted matrix; else 0.
template <class T, class Entry>
T PsdAt(int n, const T& norm, Entry entry) {
  T m[kMaxRows][kMaxRows];  // the upper triangle
  int k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) m[i][j] = entry(k++);
    m[i][i] = m[i][i] + T(kRatioBound * n * kUnit) * norm;
  }
  const T yes(1.0), no(0.0);
  T psd = yes;
  for (int j = 0; j < n; ++j) {
    const T pivot = m[j][j];
    psd = Select(pivot > no, psd, no);  // a NaN is not
    for (int i = j + 1; i < n; ++i) {
      const T factor = m[j][i] / pivot;
      for (int c = i; c < n; ++c) m[i][c] = m[i][c] - factor * m[j][c];
    }
  }
  psd = Select(norm < T(std::numeric_limits<double>::infinity()), psd, no);
  return Select(norm <= no, yes, psd);
}

auto EntriesOf(Packed a) {
  return [a](int k) { return a[static_cast<std::size_t>(k)]; };
}

}  // namespace

int PackedRows(Packed a) {
  int n = 0;
  while (n * (n + 1) / 2 < static_cast<int>(a.size())) ++n;
  return n;
}

double FrobeniusNorm(Packed a) { return PackedNorm<double>(PackedRows(a), EntriesOf(a)); }

double FrobeniusDistance(Packed a, Packed b) {
  return PackedNorm<double>(PackedRows(a), [at_a = EntriesOf(a), at_b = EntriesOf(b)](int k) {
    return at_a(k) - at_b(k);
  });
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

bool IsPsd(Packed a) { return PsdAt(PackedRows(a), FrobeniusNorm(a), EntriesOf(a)) == 1; }

void MeasureTile(int n, const double* f, const double* nearest, const double* exact,
                 std::span<Measures, kTile> measures) {
  using T = Lanes<double, kNativeLanes>;
  for (int lane = 0; lane < kTile; lane += kNativeLanes) {
    const auto at = [lane](const double* tile) {
      return [from = tile + lane](int k) { return T::Load(from + k * kTile); };
    };
    const auto at_f = at(f), at_nearest = at(nearest), at_exact = at(exact);
    const T norm = PackedNorm<T>(n, at_f);
    double numbers[4][kNativeLanes];
    norm.Store(numbers[0]);
    PackedNorm<T>(n, [&](int k) { return at_f(k) - at_nearest(k); }).Store(numbers[1]);
    PackedNorm<T>(n, [&](int k) { return at_f(k) - at_exact(k); }).Store(numbers[2]);
    PsdAt(n, norm, at_f).Store(numbers[3]);
    for (int i = 0; i < kNativeLanes; ++i) {
      measures[static_cast<std::size_t>(lane + i)] = {numbers[0][i], numbers[1][i], numbers[2][i],
                                                      numbers[3][i] == 1};
    }
  }
}

std::vector<double> Eigenvalues(Packed a) {
  const int n = PackedRows(a);
  reference::Matrix<double> upper(n, n);
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) upper(i, j) = a[k++];
  }
  return reference::EigenvaluesOf(upper).entries;
}

std::vector<double> Difference(Packed a, Packed b) {
  std::vector<double> difference(a.size());
  std::ranges::transform(a, b, difference.begin(), std::minus<>());
  return difference;
}

}  // namespace definite
