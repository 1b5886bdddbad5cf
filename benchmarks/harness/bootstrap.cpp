#include "benchmarks/harness/bootstrap.hpp"

#include <algorithm>
#include <cmath>

#include "benchmarks/harness/sampling/random.hpp"

namespace definite {
namespace {

constexpr std::size_t kResamples = 2000;
constexpr std::size_t kTail = kResamples / 40;  // 2.5 %

// Reorders its argument, which is not empty.
double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

}  // namespace

std::optional<MedianEstimate> EstimateMedian(const std::vector<double>& rounds) {
  const auto is_nan = [](double value) { return std::isnan(value); };
  if (rounds.empty() || std::any_of(rounds.begin(), rounds.end(), is_nan)) return std::nullopt;

  const double size = static_cast<double>(rounds.size());
  std::vector<double> sample(rounds.size()), medians(kResamples);
  for (std::size_t i = 0; i < kResamples; ++i) {
    Draws draws(StreamId("bootstrap"), 0, i);
    for (double& value : sample) value = rounds[static_cast<std::size_t>(size * draws.Uniform())];
    medians[i] = Median(sample);
  }
  std::sort(medians.begin(), medians.end());

  sample = rounds;
  return MedianEstimate{Median(sample), *std::min_element(rounds.begin(), rounds.end()),
                        medians[kTail - 1], medians[kResamples - kTail]};
}

}  // namespace definite
