#include "benchmarks/harness/statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace definite {
namespace {

// A double's sign, exponent and top five bits of mantissa are its bits above the 47 lowest; for
// positive numbers they ascend with the value.
constexpr int kDroppedBits = 47;
constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(0x1p-80) >> kDroppedBits;
constexpr std::uint64_t kLast = std::bit_cast<std::uint64_t>(0x1p+80) >> kDroppedBits;

constexpr std::size_t kZero = 0, kBelow = 1, kRegular = 2;
constexpr std::size_t kAbove = kRegular + (kLast - kFirst);

std::size_t BucketOf(double value) {
  if (value == 0) return kZero;
  const std::uint64_t top = std::bit_cast<std::uint64_t>(value) >> kDroppedBits;
  if (top < kFirst) return kBelow;
  return kRegular + (std::min(top, kLast) - kFirst);
}

double LowerEnd(std::size_t bucket) {
  if (bucket == kZero) return 0;
  if (bucket == kBelow) return std::numeric_limits<double>::denorm_min();
  return std::bit_cast<double>((kFirst + (bucket - kRegular)) << kDroppedBits);
}

double UpperEnd(std::size_t bucket) {
  if (bucket == kZero) return 0;
  if (bucket == kAbove) return std::numeric_limits<double>::infinity();
  return LowerEnd(bucket + 1);
}

}  // namespace

Histogram::Histogram() : counts_(kAbove + 1) {}

void Histogram::Add(double value, std::uint64_t count) {
  counts_[BucketOf(value)] += count;
  count_ += count;
}

void Histogram::Merge(const Histogram& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
}

double Histogram::Quantile(double q) const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(q * static_cast<double>(count_));
  std::uint64_t left = rank < 1 ? 1 : std::min(static_cast<std::uint64_t>(rank), count_);
  std::size_t bucket = 0;
  while (counts_[bucket] < left) left -= counts_[bucket++];
  return UpperEnd(bucket);
}

std::vector<Histogram::Bucket> Histogram::Buckets() const {
  std::vector<Bucket> buckets;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] != 0) buckets.push_back({LowerEnd(i), counts_[i]});
  }
  return buckets;
}

void Worst::Merge(const Worst& other) {
  if (other.value > value || (other.value == value && other.index < index)) *this = other;
}

Figure Figure::Of(Histogram values, double min, Worst max, std::uint64_t nan_count) {
  Figure figure;
  figure.values_ = std::move(values);
  figure.min_ = min;
  figure.max_ = max;
  figure.nan_count_ = nan_count;
  return figure;
}

void Figure::Add(double value, std::uint64_t index) {
  if (std::isnan(value)) {
    ++nan_count_;
    return;
  }
  value += 0.0;  // -0 becomes +0: else the sign of a tied extremum would depend on the order
  values_.Add(value);
  max_.Merge({value, index});
  min_ = std::min(min_, value);
}

void Figure::Merge(const Figure& other) {
  values_.Merge(other.values_);
  max_.Merge(other.max_);
  min_ = std::min(min_, other.min_);
  nan_count_ += other.nan_count_;
}

std::optional<Figure::Summary> Figure::Summarize() const {
  if (values_.Count() == 0) return std::nullopt;
  const auto quantile = [&](double q) { return std::min(values_.Quantile(q), max_.value); };
  return Summary{values_.Count(), min_, quantile(0.5), quantile(0.99), quantile(0.999), max_};
}

}  // namespace definite
