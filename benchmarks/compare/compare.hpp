#pragma once

// Two results of definite held against each other: times, and accuracy.

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/harness/bootstrap.hpp"

namespace definite {

class CompareError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Times of one row, a number for each round.
struct Timed {
  std::string key;  // the row, and what else the time hangs on
  std::vector<double> ns;
};

// Of a result of sweep or speed that has its samples. Throws CompareError if it has no times.
std::vector<Timed> TimesOf(const nlohmann::ordered_json& result);

// Why times of the two must not be compared: another machine, build, protocol or plan. Empty if
// nothing speaks against it.
std::string Differences(const nlohmann::ordered_json& base, const nlohmann::ordered_json& now);

struct Limits {
  double threshold = 0.03;  // least slowdown that counts
  double q = 0.05;          // share of false alarms among the alarms
};

struct Compared {
  std::string key;
  double base_ns, new_ns;  // medians
  MedianEstimate ratio;    // new over base, round by round
  double p;                // adjusted for many comparisons
  enum { kSame, kFaster, kSlower } verdict;
};

struct Comparison {
  std::vector<Compared> rows;
  std::vector<std::string> only_base, only_new;
  double floor = 0;            // of noise: 0.02 is 2 %
  bool floor_from_aa = false;  // or from halves of the comparison itself
  Limits limits;

  bool Regressed() const;
};

// Round by round: the rounds of two runs of one plan have the same configurations. A row is slower
// if its ratio differs from 1 after the correction for many comparisons and is beyond both the
// floor and the threshold. `again`, another run of the base, gives the floor. Throws
// CompareError if the two have no row in common.
Comparison Compare(const std::vector<Timed>& base, const std::vector<Timed>& now,
                   const std::optional<std::vector<Timed>>& again, const Limits& limits);

// What became less accurate, beyond what rounding does.
struct Loss {
  std::string row, figure;
  nlohmann::ordered_json base, now;
};

struct AccuracyComparison {
  std::size_t rows = 0;  // that both have
  std::vector<Loss> losses, gains;
  std::vector<std::string> only_base, only_new;
};

// Worst and median distance, excess and relabelling, PSD defect, rounding, verdicts and broken
// promises. Throws CompareError if the two are not of the same configurations.
AccuracyComparison CompareAccuracy(const nlohmann::ordered_json& base,
                                   const nlohmann::ordered_json& now);

// At 100 columns; as Markdown for a comment; as JSON.
std::string ToTable(const Comparison& comparison);
std::string ToTable(const AccuracyComparison& comparison);
std::string ToMarkdown(const Comparison& comparison);
std::string ToMarkdown(const AccuracyComparison& comparison);
nlohmann::ordered_json ToJson(const Comparison& comparison);
nlohmann::ordered_json ToJson(const AccuracyComparison& comparison);

}  // namespace definite
