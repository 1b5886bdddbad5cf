#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace definite {

// Statistics that merge to the same bytes in any order and for any partition of the samples: they
// hold counts, maxima and minima, never a floating-point sum.

// Counts of non-negative doubles: 32 buckets an octave (exponent and top five bits of the
// mantissa) from 2^-80 to 2^80, and three more for exact zeros, for what lies below and for what
// lies above (with infinity). A negative number or NaN is a mistake of the caller's; it is counted
// above, where it cannot hide.
class Histogram {
 public:
  struct Bucket {
    double lower;  // belongs to the bucket, so that Add(lower, count) restores it
    std::uint64_t count;
    friend bool operator==(const Bucket&, const Bucket&) = default;
  };

  Histogram();

  void Add(double value, std::uint64_t count = 1);
  void Merge(const Histogram& other);

  std::uint64_t Count() const { return count_; }

  // An upper bound of the ceil(q count)-th smallest value: 0 if that is exactly 0, else the upper
  // end of its bucket, which is at most 1/32 above it from 2^-80 to 2^80. NaN if nothing was
  // counted.
  double Quantile(double q) const;

  // The buckets that are not empty, from the lowest up.
  std::vector<Bucket> Buckets() const;

 private:
  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
};

// The greatest value, and the smallest index that has it.
struct Worst {
  double value = -std::numeric_limits<double>::infinity();
  std::uint64_t index = std::numeric_limits<std::uint64_t>::max();

  void Merge(const Worst& other);
  friend bool operator==(const Worst&, const Worst&) = default;
};

// All that is kept of one figure (distance, rounding, ...) over many configurations. NaNs are
// counted apart and enter nothing else.
class Figure {
 public:
  // The quantiles are the histogram's upper bounds, cut at the maximum.
  struct Summary {
    std::uint64_t count;
    double min, median, p99, p999;
    Worst max;
  };

  // What a figure that was written down holds. The caller sees to it that the parts fit.
  static Figure Of(Histogram values, double min, Worst max, std::uint64_t nan_count);

  void Add(double value, std::uint64_t index);
  void Merge(const Figure& other);

  std::uint64_t NanCount() const { return nan_count_; }
  const Histogram& Values() const { return values_; }
  // Nothing if there was no value (or none but NaN).
  std::optional<Summary> Summarize() const;

 private:
  Histogram values_;
  Worst max_;
  double min_ = std::numeric_limits<double>::infinity();
  std::uint64_t nan_count_ = 0;
};

}  // namespace definite
