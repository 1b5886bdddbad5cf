#include "benchmarks/harness/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "benchmarks/harness/bootstrap.hpp"
#include "benchmarks/harness/sampling/random.hpp"

namespace definite {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Histogram HistogramOf(const std::vector<double>& values) {
  Histogram histogram;
  for (const double value : values) histogram.Add(value);
  return histogram;
}

// Values over many decades, with the specials that an accuracy figure meets.
std::vector<double> Sample(std::uint64_t count) {
  std::vector<double> values;
  for (std::uint64_t index = 0; index < count; ++index) {
    Draws draws(StreamId("statistics"), 1, index);
    const double kind = draws.Uniform();
    const double decade = 20 * draws.Uniform() - 17;
    values.push_back(kind < 0.01   ? 0.0
                     : kind < 0.02 ? -0.0
                     : kind < 0.03 ? kNaN
                     : kind < 0.04 ? 1e-30
                     : kind < 0.05 ? 1e3
                                   : std::pow(10.0, decade));
  }
  return values;
}

// Every bit that a figure can be asked for.
std::string Bytes(const Figure& figure) {
  std::ostringstream out;
  const auto write = [&](double x) { out << std::hex << std::bit_cast<std::uint64_t>(x) << ' '; };
  out << figure.NanCount() << ' ' << figure.Values().Count() << '\n';
  for (const auto& [lower, count] : figure.Values().Buckets()) {
    write(lower);
    out << count << '\n';
  }
  if (const auto summary = figure.Summarize()) {
    for (const double x : {summary->min, summary->median, summary->p99, summary->p999}) write(x);
    write(summary->max.value);
    out << summary->count << ' ' << summary->max.index << '\n';
  }
  return out.str();
}

TEST(Histogram, BoundsEveryQuantileFromAboveWithinOneBucket) {
  std::vector<double> values;
  for (const double value : Sample(10007)) {
    if (!std::isnan(value)) values.push_back(value);
  }
  const Histogram histogram = HistogramOf(values);
  std::sort(values.begin(), values.end());
  for (const double q : {0.0, 1e-5, 0.005, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0}) {
    const double rank = std::max(1.0, std::ceil(q * static_cast<double>(values.size())));
    const double exact = values[static_cast<std::size_t>(rank) - 1];
    EXPECT_GE(histogram.Quantile(q), exact) << q;
    const double limit = exact == 0 ? 0 : std::max(exact * (1 + 1.0 / 32), 0x1p-80);
    EXPECT_LE(histogram.Quantile(q), limit) << q;
  }
}

TEST(Histogram, BoundsASingleValueFromAboveOverItsWholeRange) {
  for (int exponent = -80; exponent < 80; ++exponent) {
    for (int step = 0; step < 64; ++step) {  // bucket ends and middles
      const double value = std::ldexp(1 + step / 64.0, exponent);
      for (const double x : {value, std::nextafter(value, kInfinity)}) {
        const double bound = HistogramOf({x}).Quantile(0.5);
        ASSERT_GT(bound, x);
        ASSERT_LE(bound, x * (1 + 1.0 / 32));
      }
    }
  }
}

TEST(Histogram, HasThirtyTwoBucketsAnOctave) {
  Histogram histogram;
  for (int i = 0; i < 3200; ++i) histogram.Add(1 + i / 3200.0);
  ASSERT_EQ(histogram.Buckets().size(), 32U);
  for (std::size_t i = 0; i < 32; ++i) {
    EXPECT_EQ(histogram.Buckets()[i].lower, 1 + static_cast<double>(i) / 32);
    EXPECT_EQ(histogram.Buckets()[i].count, 100U);
  }
}

TEST(Histogram, TellsExactZeroFromTheTiny) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Histogram histogram = HistogramOf({0.0, -0.0, tiny, std::nextafter(0x1p-80, 0)});
  EXPECT_EQ(histogram.Buckets(), (std::vector<Histogram::Bucket>{{0, 2}, {tiny, 2}}));
  EXPECT_EQ(histogram.Quantile(0.5), 0);
  EXPECT_EQ(histogram.Quantile(0.51), 0x1p-80);
}

TEST(Histogram, CountsWhatIsTooLargeNegativeOrNaNAbove) {
  const Histogram histogram = HistogramOf({0x1p80, 1e300, kInfinity, -1e-3, kNaN, -kNaN});
  EXPECT_EQ(histogram.Buckets(), (std::vector<Histogram::Bucket>{{0x1p80, 6}}));
  EXPECT_EQ(histogram.Quantile(0.01), kInfinity);
  EXPECT_LE(HistogramOf({std::nextafter(0x1p80, 0)}).Quantile(1), 0x1p80);
}

TEST(Histogram, IsRestoredFromItsBuckets) {
  const Histogram histogram = HistogramOf(Sample(5000));
  Histogram restored;
  for (const auto& [lower, count] : histogram.Buckets()) restored.Add(lower, count);
  EXPECT_EQ(restored.Buckets(), histogram.Buckets());
  EXPECT_EQ(restored.Count(), histogram.Count());
  for (const double q : {0.01, 0.03, 0.5, 1.0})
    EXPECT_EQ(restored.Quantile(q), histogram.Quantile(q));
}

TEST(Histogram, MergesToTheCountsOfTheWhole) {
  const std::vector<double> values = Sample(5000);
  Histogram left = HistogramOf({values.begin(), values.begin() + 1234});
  left.Merge(HistogramOf({values.begin() + 1234, values.end()}));
  EXPECT_EQ(left.Buckets(), HistogramOf(values).Buckets());
  EXPECT_EQ(left.Count(), values.size());
}

TEST(Histogram, KnowsNoQuantileOfNothing) {
  EXPECT_TRUE(std::isnan(Histogram().Quantile(0.5)));
  EXPECT_TRUE(Histogram().Buckets().empty());
}

TEST(Worst, IsTheSmallestIndexOfTheGreatestValue) {
  Worst worst;
  worst.Merge({1, 7});
  worst.Merge({3, 9});
  worst.Merge({3, 5});
  worst.Merge({3, 6});
  worst.Merge({2, 1});
  worst.Merge({});
  EXPECT_EQ(worst, (Worst{3, 5}));
}

TEST(Figure, SummarizesTheSamples) {
  Figure figure;
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    values.push_back(std::ldexp(1.0 + static_cast<double>(i * 7919 % 2000) / 2000, -10));
    figure.Add(values.back(), i);
  }
  const auto summary = figure.Summarize();
  const auto worst = std::max_element(values.begin(), values.end()) - values.begin();
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->count, 2000U);
  EXPECT_EQ(summary->min, sorted.front());
  EXPECT_EQ(summary->max, (Worst{sorted.back(), static_cast<std::uint64_t>(worst)}));
  const std::pair<double, double> kQuantiles[] = {
      {summary->median, sorted[999]}, {summary->p99, sorted[1979]}, {summary->p999, sorted[1997]}};
  for (const auto& [bound, exact] : kQuantiles) {
    EXPECT_GE(bound, exact);
    EXPECT_LE(bound, exact * (1 + 1.0 / 32));
  }
}

TEST(Figure, NeverReportsAQuantileAboveItsMaximum) {
  Figure figure;
  figure.Add(1.001, 0);
  EXPECT_EQ(figure.Summarize()->median, 1.001);
  EXPECT_EQ(figure.Summarize()->p999, 1.001);
}

TEST(Figure, CountsNaNsApart) {
  Figure figure;
  figure.Add(kNaN, 0);
  figure.Add(-kNaN, 1);
  EXPECT_EQ(figure.NanCount(), 2U);
  EXPECT_FALSE(figure.Summarize());
  figure.Add(2, 2);
  EXPECT_EQ(figure.NanCount(), 2U);
  EXPECT_EQ(figure.Summarize()->count, 1U);
  EXPECT_EQ(figure.Summarize()->min, 2);
  EXPECT_EQ(figure.Summarize()->max, (Worst{2, 2}));
}

// Deals the samples to `parts` figures in blocks of 64, the way threads take them, and merges
// those in the order of a shuffle.
Figure Partitioned(const std::vector<double>& values, std::size_t parts, std::uint64_t shuffle) {
  std::vector<Figure> figures(parts);
  Draws draws(StreamId("partition"), shuffle, 0);
  std::size_t owner = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % 64 == 0) owner = draws.Bits() % parts;
    figures[owner].Add(values[i], i);
  }
  for (std::size_t i = parts - 1; i > 0; --i)
    std::swap(figures[i], figures[draws.Bits() % (i + 1)]);
  Figure merged;
  for (const Figure& figure : figures) merged.Merge(figure);
  return merged;
}

TEST(Figure, HasTheSameBytesForAnyPartitionAndOrderOfMerges) {
  const std::vector<double> values = Sample(20000);
  // Of zeros of both signs, the minimum and maximum of the second sample, -0 comes first.
  const std::vector<double> zeros = {-0.0, 0.0, -0.0, 0.0};
  for (const auto& sample : {values, zeros}) {
    const std::string whole = Bytes(Partitioned(sample, 1, 0));
    for (const std::size_t parts : {1U, 2U, 7U}) {
      for (std::uint64_t shuffle = 0; shuffle < 10; ++shuffle) {
        EXPECT_EQ(Bytes(Partitioned(sample, parts, shuffle)), whole);
      }
    }
  }
}

TEST(Figure, ForgetsTheSignOfZero) {
  for (const auto& [first, second] : {std::pair{-0.0, 0.0}, std::pair{0.0, -0.0}}) {
    Figure figure;
    figure.Add(first, 0);
    figure.Add(second, 1);
    EXPECT_FALSE(std::signbit(figure.Summarize()->min));
    EXPECT_FALSE(std::signbit(figure.Summarize()->max.value));
    EXPECT_EQ(figure.Summarize()->max.index, 0U);
  }
}

TEST(Figure, MergesAssociativelyAndCommutatively) {
  const std::vector<double> values = Sample(3000);
  Figure a, b, c;
  for (std::size_t i = 0; i < values.size(); ++i)
    (i % 3 == 0 ? a : i % 3 == 1 ? b : c).Add(values[i], i);
  Figure ab = a, bc = b, cb = c;
  ab.Merge(b);
  ab.Merge(c);
  bc.Merge(c);
  Figure a_bc = a;
  a_bc.Merge(bc);
  cb.Merge(b);
  cb.Merge(a);
  EXPECT_EQ(Bytes(ab), Bytes(a_bc));
  EXPECT_EQ(Bytes(ab), Bytes(cb));
}

TEST(Bootstrap, FindsMedianAndMinimum) {
  const auto odd = EstimateMedian({5, 1, 4, 2, 3});
  EXPECT_EQ(odd->median, 3);
  EXPECT_EQ(odd->minimum, 1);
  EXPECT_EQ(EstimateMedian({4, 1, 3, 2})->median, 2.5);
}

TEST(Bootstrap, KnowsNothingOfNoRoundsOrNaN) {
  EXPECT_FALSE(EstimateMedian({}));
  EXPECT_FALSE(EstimateMedian({1, kNaN, 2}));
}

TEST(Bootstrap, GivesOneRoundAnIntervalOfNoWidth) {
  const auto one = EstimateMedian({2.5});
  EXPECT_EQ(one->low, 2.5);
  EXPECT_EQ(one->high, 2.5);
}

TEST(Bootstrap, IsTheSameInEveryRun) {
  std::vector<double> rounds;  // an even number: their medians are means, and take many values
  for (std::uint64_t i = 0; i < 30; ++i) rounds.push_back(Draws(7, 7, i).Uniform());
  const std::vector<double> copy = rounds;
  const auto first = EstimateMedian(rounds), second = EstimateMedian(copy);
  EXPECT_EQ(first->low, second->low);
  EXPECT_EQ(first->high, second->high);
  EXPECT_EQ(first->low, 0x1.747661abf390ap-3);
  EXPECT_EQ(first->high, 0x1.4c06d67f59c6fp-1);
}

TEST(Bootstrap, CoversTheTrueMedianNineteenTimesInTwenty) {
  constexpr int kExperiments = 500;
  for (const int size : {9, 16, 50}) {
    int below = 0, above = 0;
    for (std::uint64_t experiment = 0; experiment < kExperiments; ++experiment) {
      Draws draws(StreamId("coverage"), static_cast<std::uint64_t>(size), experiment);
      std::vector<double> rounds;
      // Skewed like times: the true median is 1.
      for (int i = 0; i < size; ++i) rounds.push_back(std::exp(0.1 * draws.Normal()));
      const auto estimate = EstimateMedian(rounds);
      ASSERT_LE(estimate->low, estimate->median);
      ASSERT_GE(estimate->high, estimate->median);
      below += estimate->high < 1;
      above += estimate->low > 1;
    }
    // Each tail should miss in 2.5 % of the experiments (12.5 of 500); percentile intervals of so
    // few rounds are a little narrow, and are as often on one side as on the other.
    EXPECT_GE(below, 3) << size;
    EXPECT_LE(below, 30) << size;
    EXPECT_GE(above, 3) << size;
    EXPECT_LE(above, 30) << size;
  }
}

}  // namespace
}  // namespace definite
