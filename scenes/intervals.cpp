#include "scenes/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace definite::scenes {

namespace {

// How far the Wilson interval reaches below and above a fraction.
struct Reach {
  double fraction, below, above;
};

Reach ReachOf(std::uint64_t count, std::uint64_t of) {
  const double fraction = static_cast<double>(count) / static_cast<double>(of);
  const Interval wilson = WilsonInterval(count, of);
  return {fraction, fraction - wilson.low, wilson.high - fraction};
}

// With `phi`, the correlation of the two.
Interval Combined(const Reach& first, const Reach& second, double phi) {
  const auto reach = [phi](double a, double b) {
    return std::sqrt(std::max(0.0, a * a - 2 * phi * a * b + b * b));
  };
  const double difference = second.fraction - first.fraction;
  return {difference - reach(second.below, first.above),
          difference + reach(second.above, first.below)};
}

}  // namespace

Interval WilsonInterval(std::uint64_t count, std::uint64_t of) {
  static const double kZ = boost::math::quantile(boost::math::normal(), 0.975);
  const auto n = static_cast<double>(of);
  const double p = static_cast<double>(count) / n, z2 = kZ * kZ;
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double reach = kZ / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  // Exact at the ends, where the formula rounds.
  return {count == 0 ? 0 : middle - reach, count == of ? 1 : middle + reach};
}

Interval DifferenceInterval(std::uint64_t first, std::uint64_t of_first, std::uint64_t second,
                            std::uint64_t of_second) {
  return Combined(ReachOf(first, of_first), ReachOf(second, of_second), 0);
}

Interval PairedInterval(const std::vector<bool>& first, const std::vector<bool>& second) {
  double both = 0, only_first = 0, only_second = 0, neither = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    (first[i] ? (second[i] ? both : only_first) : (second[i] ? only_second : neither)) += 1;
  }
  const double margins =
      (both + only_first) * (only_second + neither) * (both + only_second) * (only_first + neither);
  double phi = 0;
  if (margins > 0) {
    const double n = static_cast<double>(first.size()), product = both * neither;
    double excess = product - only_first * only_second;
    // Newcombe's correction for continuity.
    if (excess > n / 2) {
      excess -= n / 2;
    } else if (excess >= 0) {
      excess = 0;
    }
    phi = excess / std::sqrt(margins);
  }
  const auto count = [](double a, double b) { return static_cast<std::uint64_t>(a + b); };
  return Combined(ReachOf(count(both, only_first), first.size()),
                  ReachOf(count(both, only_second), first.size()), phi);
}

double FisherTest(std::uint64_t first, std::uint64_t of_first, std::uint64_t second,
                  std::uint64_t of_second) {
  const std::uint64_t all = of_first + of_second, failing = first + second;
  if (failing == 0 || failing == all) return 1;
  const boost::math::hypergeometric_distribution<double> distribution(
      static_cast<unsigned>(failing), static_cast<unsigned>(of_first), static_cast<unsigned>(all));
  const double here = boost::math::pdf(distribution, first);
  double p = 0;
  const std::uint64_t least = failing > of_second ? failing - of_second : 0;
  for (std::uint64_t k = least; k <= std::min(failing, of_first); ++k) {
    const double other = boost::math::pdf(distribution, k);
    if (other <= here * (1 + 1e-9)) p += other;
  }
  return std::min(p, 1.0);
}

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace definite::scenes
