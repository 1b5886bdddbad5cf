// Two results held against each other.

#include "benchmarks/compare/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/compare/export.hpp"
#include "benchmarks/compare/significance.hpp"
#include "benchmarks/harness/sampling/random.hpp"

namespace definite {
namespace {

using Json = nlohmann::ordered_json;

TEST(SignedRank, HasThePValuesOfTheTables) {
  // All of n positive: 2 / 2^n. One of the smallest rank negative: 4 / 2^n.
  EXPECT_DOUBLE_EQ(SignedRankP({1, 2, 3, 4, 5}), 2.0 / 32);
  EXPECT_DOUBLE_EQ(SignedRankP({-1, 2, 3, 4, 5}), 4.0 / 32);
  EXPECT_DOUBLE_EQ(SignedRankP({1, -2, 3, -4}), 14.0 / 16);  // W = 4 of 10: 7 of 16 lie below
  // n = 15, W = 25 is the two-sided 5 % point of the tables.
  std::vector<double> values;
  for (int i = 1; i <= 15; ++i) values.push_back(i == 10 || i == 15 ? -i : i);
  EXPECT_LE(SignedRankP(values), 0.05);
  values[0] = -1;  // W = 26
  EXPECT_GT(SignedRankP(values), 0.05);
}

TEST(SignedRank, KnowsNothingOfNothing) {
  EXPECT_EQ(SignedRankP({}), 1);
  EXPECT_EQ(SignedRankP({0, 0, 0}), 1);
}

TEST(SignedRank, TakesTiesAndManyByTheNormalApproximation) {
  std::vector<double> values;
  for (int i = 1; i <= 50; ++i) values.push_back(i % 3 == 0 ? -i : i);
  const double exact = SignedRankP(values);
  values.push_back(0);  // a tie of its own: the approximation, of nearly the same ranks
  EXPECT_NEAR(SignedRankP(values), exact, 0.1 * exact);
  // All of one size, it is a sign test, whose p-value is 2 / 2^12.
  EXPECT_NEAR(SignedRankP(std::vector<double>(12, 0.5)), 4.9e-4, 2e-4);
}

TEST(ManyComparisons, AreAdjustedAsBenjaminiAndHochbergHaveIt) {
  const std::vector<double> adjusted = AdjustForMany({0.01, 0.04, 0.03, 0.005});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.02);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[3], 0.02);
  // 0.02 alone: never more than what a greater one becomes.
  EXPECT_DOUBLE_EQ(AdjustForMany({0.01, 0.011})[0], 0.011);
  EXPECT_TRUE(AdjustForMany({}).empty());
}

// Rounds of rows that take 10, 11, ... ns, with noise of about one percent.
std::vector<Timed> TimesOfRun(std::uint64_t seed, int rows, int rounds = 15) {
  std::vector<Timed> times;
  for (int r = 0; r < rows; ++r) {
    Timed timed{"row " + std::to_string(r), {}};
    for (int i = 0; i < rounds; ++i) {
      Draws draws(StreamId("compare"), seed, static_cast<std::uint64_t>(1000 * r + i));
      timed.ns.push_back((10 + r) * (1 + 0.02 * (draws.Uniform() - 0.5)));
    }
    times.push_back(timed);
  }
  return times;
}

TEST(Compare, RaisesNoAlarmOverTwentyRunsOfTheSame) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Comparison comparison =
        Compare(TimesOfRun(2 * seed, 40), TimesOfRun(2 * seed + 1, 40), {}, {});
    EXPECT_FALSE(comparison.Regressed()) << seed;
    EXPECT_EQ(comparison.rows.size(), 40u);
  }
}

TEST(Compare, NamesTheRowThatBecameSlower) {
  std::vector<Timed> now = TimesOfRun(1, 40);
  for (double& ns : now[7].ns) ns *= 1.05;
  for (double& ns : now[9].ns) ns /= 1.06;
  const Comparison comparison = Compare(TimesOfRun(0, 40), now, {}, {});
  EXPECT_TRUE(comparison.Regressed());
  for (std::size_t r = 0; r < comparison.rows.size(); ++r) {
    EXPECT_EQ(comparison.rows[r].verdict, r == 7   ? Compared::kSlower
                                          : r == 9 ? Compared::kFaster
                                                   : Compared::kSame)
        << r;
  }
  EXPECT_NEAR(comparison.rows[7].ratio.median, 1.05, 0.02);
}

TEST(Compare, SaysNothingBelowTheThresholdOrTheFloor) {
  std::vector<Timed> now = TimesOfRun(1, 40);
  for (double& ns : now[7].ns) ns *= 1.05;
  EXPECT_FALSE(Compare(TimesOfRun(0, 40), now, {}, {.threshold = 0.1}).Regressed());
  // Another run of the base that is 8 % off: such a machine shows no 5 %.
  std::vector<Timed> again = TimesOfRun(2, 40);
  for (Timed& timed : again) {
    for (double& ns : timed.ns) ns *= 1.08;
  }
  const Comparison comparison = Compare(TimesOfRun(0, 40), now, again, {});
  EXPECT_NEAR(comparison.floor, 0.08, 0.02);
  EXPECT_TRUE(comparison.floor_from_aa);
  EXPECT_FALSE(comparison.Regressed());
}

TEST(Compare, SaysNothingFromTwoRounds) {
  std::vector<Timed> now = TimesOfRun(1, 3, 2);
  for (double& ns : now[0].ns) ns *= 2;
  EXPECT_FALSE(Compare(TimesOfRun(0, 3, 2), now, {}, {}).Regressed());
}

TEST(Compare, ListsMissingAndNewRows) {
  std::vector<Timed> now = TimesOfRun(1, 3);
  now[0].key = "another";
  const Comparison comparison = Compare(TimesOfRun(0, 3), now, {}, {});
  EXPECT_EQ(comparison.only_base, std::vector<std::string>{"row 0"});
  EXPECT_EQ(comparison.only_new, std::vector<std::string>{"another"});
  EXPECT_NE(ToTable(comparison).find("missing from the new: row 0"), std::string::npos);
  EXPECT_NE(ToMarkdown(comparison).find("New: another"), std::string::npos);
}

// A result with one row whose figures are plain.
Json Result() {
  Json figure = {{"median", 0.5}, {"max", {{"value", 1.0}, {"index", 3}}}};
  Json row = {{"kernel", "a/b"}, {"distribution", "active"}, {"count", 100}, {"active", 90}};
  for (const char* name : {"distance", "excess", "relabelling", "psd_defect", "rounding",
                           "conditioned_rounding", "value_rounding", "gradient_rounding"}) {
    row["accuracy"][name] = figure;
  }
  row["verdicts"] = {{"pass", 90}, {"degraded", 0}};
  row["broken_promises"] = Json::array();
  return {{"rows", Json::array({row})}};
}

TEST(Accuracy, OfTheSameIsNotLost) {
  const AccuracyComparison comparison = CompareAccuracy(Result(), Result());
  EXPECT_EQ(comparison.rows, 1u);
  EXPECT_TRUE(comparison.losses.empty());
  EXPECT_TRUE(comparison.gains.empty());
}

TEST(Accuracy, IsLostAtAnySizeBeyondRounding) {
  const auto losses = [](auto change) {
    Json now = Result();
    change(now["rows"][0]);
    return CompareAccuracy(Result(), now).losses.size();
  };
  const auto max = [](Json& row, const char* figure) -> Json& {
    return row["accuracy"][figure]["max"]["value"];
  };
  EXPECT_EQ(losses([&](Json& row) { max(row, "distance") = 1 + 1e-5; }), 1u);
  EXPECT_EQ(losses([&](Json& row) { max(row, "distance") = 1 + 1e-9; }), 0u);
  EXPECT_EQ(losses([&](Json& row) { max(row, "distance") = "inf"; }), 1u);
  EXPECT_EQ(losses([&](Json& row) { row["accuracy"]["distance"]["median"] = 0.51; }), 1u);
  EXPECT_EQ(losses([&](Json& row) { max(row, "psd_defect") = 3.0; }), 0u);
  EXPECT_EQ(losses([&](Json& row) { max(row, "psd_defect") = 9.0; }), 1u);
  EXPECT_EQ(losses([&](Json& row) { row["verdicts"]["degraded"] = 1; }), 1u);
  EXPECT_EQ(losses([&](Json& row) {
              row["broken_promises"].push_back({{"property", "psd"}, {"index", 4}});
            }),
            1u);
}

TEST(Accuracy, IsLostInAWorstCaseToo) {
  Json now = Result();
  now["rows"][0]["worst_cases"]["broken_promises"] =
      Json::array({{{"property", "accurate"}, {"index", 4}}});
  EXPECT_EQ(CompareAccuracy(Result(), now).losses.size(), 1u);
}

TEST(Compare, OfNothingInCommonIsNoComparison) {
  std::vector<Timed> now = TimesOfRun(1, 1);
  now[0].key = "another";
  EXPECT_THROW(Compare(TimesOfRun(0, 1), now, {}, {}), CompareError);
}

TEST(Accuracy, ThatIsGainedIsNotLost) {
  Json base = Result();
  base["rows"][0]["accuracy"]["distance"]["max"]["value"] = 2.0;
  base["rows"][0]["broken_promises"].push_back({{"property", "psd"}, {"index", 4}});
  const AccuracyComparison comparison = CompareAccuracy(base, Result());
  EXPECT_TRUE(comparison.losses.empty());
  EXPECT_EQ(comparison.gains.size(), 2u);
}

TEST(Accuracy, OfOtherConfigurationsIsNotCompared) {
  Json now = Result();
  now["rows"][0]["active"] = 89;
  EXPECT_THROW(CompareAccuracy(Result(), now), CompareError);
  now = Result();
  now["rows"][0]["kernel"] = "another";
  EXPECT_THROW(CompareAccuracy(Result(), now), CompareError);
}

TEST(Export, IsWhatGithubActionBenchmarkReads) {
  Json result = Result();
  result["rows"][0]["timing"] = Json::array(
      {{{"pairs", "all"}, {"threads", 2}, {"samples", Json::array({10.0, 12.0, 11.0})}}});
  const Json list = ToCustomSmallerIsBetter(result);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["name"], "a/b, active, all pairs, 2 threads");
  EXPECT_EQ(list[0]["unit"], "ns");
  EXPECT_EQ(list[0]["value"], 11.0);
  EXPECT_TRUE(list[0]["range"].is_string());
  result["rows"][0]["timing"] = Json::array();
  EXPECT_THROW(ToCustomSmallerIsBetter(result), CompareError);
}

}  // namespace
}  // namespace definite
