#include "benchmarks/compare/significance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace definite {

namespace {

constexpr std::size_t kMostExact = 50;

// P(W <= w) of the sum of those of the ranks 1 .. n that are positive, each with probability 1/2.
double Below(std::size_t n, double w) {
  std::vector<double> ways(n * (n + 1) / 2 + 1);
  ways[0] = 1;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t sum = ways.size() - 1; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  }
  double below = 0;
  for (std::size_t sum = 0; sum < ways.size() && static_cast<double>(sum) <= w; ++sum) {
    below += ways[sum];
  }
  return below * std::pow(0.5, static_cast<double>(n));
}

std::vector<std::size_t> Order(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  return order;
}

}  // namespace

double SignedRankP(const std::vector<double>& values) {
  const std::size_t n = values.size();
  if (n == 0) return 1;
  std::vector<double> sizes;
  for (double v : values) sizes.push_back(std::abs(v));
  const std::vector<std::size_t> order = Order(sizes);
  double positive = 0, ties = 0;
  bool tied = false;
  for (std::size_t i = 0, j = 0; i < n; i = j) {
    while (j < n && sizes[order[j]] == sizes[order[i]]) ++j;
    const double rank = 0.5 * static_cast<double>(i + 1 + j);  // the mean of i+1 .. j
    const double count = static_cast<double>(j - i);
    if (j - i > 1 || sizes[order[i]] == 0) tied = true;
    ties += count * (count * count - 1);
    for (std::size_t k = i; k < j; ++k) {
      const double v = values[order[k]];
      positive += v > 0 ? rank : v == 0 ? 0.5 * rank : 0;
    }
  }
  const double count = static_cast<double>(n), sum = 0.5 * count * (count + 1);
  const double smaller = std::min(positive, sum - positive);
  if (!tied && n <= kMostExact) return std::min(1.0, 2 * Below(n, smaller));
  const double variance = count * (count + 1) * (2 * count + 1) / 24 - ties / 48;
  if (!(variance > 0)) return 1;
  const double z = std::min(0.0, (smaller + 0.5 - 0.5 * sum) / std::sqrt(variance));
  return std::min(1.0, std::erfc(-z / std::sqrt(2.0)));
}

std::vector<double> AdjustForMany(const std::vector<double>& p) {
  const std::vector<std::size_t> order = Order(p);
  std::vector<double> adjusted(p.size());
  double least = 1;
  for (std::size_t i = p.size(); i > 0; --i) {
    const std::size_t at = order[i - 1];
    least = std::min(least, p[at] * static_cast<double>(p.size()) / static_cast<double>(i));
    adjusted[at] = least;
  }
  return adjusted;
}

}  // namespace definite
