#pragma once

// What a few ratios say: whether they differ from 1, and which of many do.

#include <vector>

namespace definite {

// Two-sided p-value of Wilcoxon's signed-rank test that the values are symmetric about 0 (Wilcoxon
// 1945): exact without ties and up to 50 values, else by the normal approximation with its
// correction for ties. Values of 0 count half on each side. 1 without values.
double SignedRankP(const std::vector<double>& values);

// Benjamini & Hochberg 1995: the p-values, adjusted so that those below q have at most a share q of
// false alarms among them.
std::vector<double> AdjustForMany(const std::vector<double>& p);

}  // namespace definite
