#pragma once

#include <optional>
#include <vector>

namespace definite {

struct MedianEstimate {
  double median, minimum;
  double low, high;  // 95 % interval of the median
};

// The median of a few rounds' times or ratios with its percentile-bootstrap interval (Efron &
// Tibshirani 1993, section 13.3), from 2000 resamples that are the same in every run. Nothing if
// there are no rounds or one of them is NaN.
std::optional<MedianEstimate> EstimateMedian(const std::vector<double>& rounds);

}  // namespace definite
