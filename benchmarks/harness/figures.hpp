#pragma once

// The measures of docs/protocol.md, section 1, on packed symmetric matrices of n rows in double.

#include <span>
#include <vector>

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

// All eigenvalues, ascending; NaN if an entry is not finite.
std::vector<double> Eigenvalues(Packed a);

// a - b.
std::vector<double> Difference(Packed a, Packed b);

}  // namespace definite
