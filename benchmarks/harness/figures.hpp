#pragma once

// The measures of docs/protocol.md, section 1, on packed symmetric matrices of n rows in double.

#include <span>
#include <vector>

#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {

// Test ratios are relative to n u |F|; above this bound a matrix is not PSD, or not accurate.
inline constexpr double kRatioBound = 50;
inline constexpr double kUnit = 0x1p-53;  // u

using Packed = std::span<const double>;  // upper triangle, row by row

int PackedRows(Packed a);
double FrobeniusNorm(Packed a);
double FrobeniusDistance(Packed a, Packed b);
bool AllFinite(Packed a);
bool AllZero(Packed a);

// |a - b| / |b|, where 0/0 is 0.
double RelativeDistance(Packed a, Packed b);

// Whether lambda_min(a) >= -kRatioBound n u |a|, by the pivots of the shifted matrix.
bool IsPsd(Packed a);

// What is asked of every matrix F, beside P and H.
struct Measures {
  double norm, to_nearest, to_exact;  // |F|, |F - P|, |F - H|
  bool psd;                           // IsPsd(F)
};

// Of a tile of each; the same bits as one by one.
void MeasureTile(int n, const double* f, const double* nearest, const double* exact,
                 std::span<Measures, kTile> measures);

// All eigenvalues, ascending; NaN if an entry is not finite.
std::vector<double> Eigenvalues(Packed a);

// a - b.
std::vector<double> Difference(Packed a, Packed b);

}  // namespace definite
