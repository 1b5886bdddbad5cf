// The judge and the two passes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>

#include "benchmarks/harness/checked_pass.hpp"
#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/timed_pass.hpp"
#include "tests/contracts.hpp"

namespace definite {
namespace {

constexpr const char* kEnergy = "collision/vertex_face/signed/quadratic";
constexpr const char* kOther = "collision/vertex_face/unsigned/quadratic";

const KernelRow& Row(const std::string& filter) {
  return *FindKernel(std::string(kEnergy) + "/" + filter);
}

// The rows of two energies: enough to be mixed up.
SweepPlan Plan(std::uint64_t count, int threads) {
  SweepPlan plan;
  for (const KernelRow& row : AllKernels()) {
    if (row.energy->name == kEnergy || row.energy->name == kOther) plan.rows.push_back(&row);
  }
  plan.distribution = FindDistribution("active");
  plan.samples.truth = 100;  // a millisecond each
  plan.count = count;
  plan.threads = threads;
  plan.timing = false;
  return plan;
}

std::string RowsOf(const SweepResult& result) { return ToJson(result, {"test"})["rows"].dump(); }

// Packed symmetric matrix of n rows with this diagonal.
std::vector<double> Diagonal(std::vector<double> diagonal) {
  std::vector<double> a;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    for (std::size_t j = i; j < diagonal.size(); ++j) a.push_back(i == j ? diagonal[i] : 0);
  }
  return a;
}

TEST(Figures, CountOffDiagonalEntriesTwice) {
  const std::vector<double> a = {3, 4, 0};  // [[3, 4], [4, 0]]
  EXPECT_DOUBLE_EQ(FrobeniusNorm(a), std::sqrt(9.0 + 16 + 16));
  EXPECT_DOUBLE_EQ(FrobeniusDistance(a, {{3, 0, 0}}), std::sqrt(32.0));
  EXPECT_EQ(PackedRows(std::vector<double>(78)), 12);
}

TEST(Figures, CallAMatrixPsdUpToTheRatioBound) {
  const double n = 4;
  for (double norm : {1.0, 1e-100, 1e-6, 1e6, 1e100}) {
    const double slack = kRatioBound * n * kUnit * norm;
    EXPECT_TRUE(IsPsd(Diagonal({norm, 0, 0, 0}))) << norm;
    EXPECT_TRUE(IsPsd(Diagonal({norm, 0, 0, -0.9 * slack}))) << norm;
    EXPECT_FALSE(IsPsd(Diagonal({norm, 0, 0, -1.1 * slack}))) << norm;
  }
  EXPECT_TRUE(IsPsd(Diagonal({0, 0, 0, 0})));
  EXPECT_FALSE(IsPsd(Diagonal({-1, 0, 0, 0})));
  EXPECT_FALSE(IsPsd(Diagonal({1, std::nan(""), 0, 0})));
  EXPECT_FALSE(IsPsd(Diagonal({1, std::numeric_limits<double>::infinity(), 0, 0})));
}

TEST(Figures, MeasureATileLikeItsMatricesOneByOne) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const int n : {2, 6, 9, 12}) {
    const auto size = static_cast<std::size_t>(n * (n + 1) / 2);
    std::vector<std::vector<double>> tiles(3), scalar(3);
    for (std::size_t which = 0; which < 3; ++which) {
      Draws draws(StreamId("measures"), which, static_cast<std::uint64_t>(n));
      scalar[which].resize(size * kTile);
      for (double& entry : scalar[which]) entry = draws.Uniform() - 0.5;
      tiles[which].resize(size * kTile);
    }
    // PSD, zero, not finite, and of a norm that overflows.
    std::vector<double>& f = scalar[0];
    const auto matrix = [&](std::size_t i) { return f.begin() + static_cast<long>(i * size); };
    for (std::size_t i : {0u, 1u, 2u, 4u}) std::fill_n(matrix(i), size, 0.0);
    for (std::size_t k = 0, i = 0; i < static_cast<std::size_t>(n); ++i) {
      matrix(0)[static_cast<long>(k)] = 1;
      k += static_cast<std::size_t>(n) - i;
    }
    matrix(2)[1] = std::nan("");
    matrix(3)[0] = inf;
    matrix(4)[0] = 1e300;
    for (std::size_t which = 0; which < 3; ++which) {
      ToTiles(scalar[which].data(), static_cast<int>(size), kTile, tiles[which].data());
    }
    std::array<Measures, kTile> measures;
    MeasureTile(n, tiles[0].data(), tiles[1].data(), tiles[2].data(), measures);
    for (std::size_t i = 0; i < kTile; ++i) {
      const auto one = [&](std::size_t which) {
        return Packed(scalar[which]).subspan(i * size, size);
      };
      // In bits, for a NaN is not equal to itself.
      const auto bits = [](double a) { return std::bit_cast<std::uint64_t>(std::abs(a)); };
      EXPECT_EQ(bits(measures[i].norm), bits(FrobeniusNorm(one(0)))) << n << " " << i;
      EXPECT_EQ(bits(measures[i].to_nearest), bits(FrobeniusDistance(one(0), one(1))));
      EXPECT_EQ(bits(measures[i].to_exact), bits(FrobeniusDistance(one(0), one(2))));
      EXPECT_EQ(measures[i].psd, IsPsd(one(0))) << n << " " << i;
    }
    EXPECT_TRUE(measures[0].psd);
    EXPECT_TRUE(measures[1].psd);
    for (std::size_t i = 2; i < 5; ++i) EXPECT_FALSE(measures[i].psd) << i;
  }
}

TEST(Figures, KnowEigenvalues) {
  const std::vector<double> values = Eigenvalues(std::vector<double>{2, 1, 2});
  EXPECT_NEAR(values[0], 1, 1e-15);
  EXPECT_NEAR(values[1], 3, 1e-15);
}

TEST(Figures, TakeZeroOverZeroForZero) {
  EXPECT_EQ(RelativeDistance(Diagonal({0, 0}), Diagonal({0, 0})), 0);
  EXPECT_EQ(RelativeDistance(Diagonal({1, 0}), Diagonal({0, 0})),
            std::numeric_limits<double>::infinity());
}

TEST(Tiles, ComeBackAsTheyWere) {
  std::vector<double> numbers(3 * 16), tiled(3 * 16), back(3 * 16);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  ToTiles(numbers.data(), 3, 16, tiled.data());
  EXPECT_EQ(tiled[1], 3);    // number 0 of configuration 1
  EXPECT_EQ(tiled[8], 1);    // number 1 of configuration 0
  EXPECT_EQ(tiled[24], 24);  // the second tile
  FromTiles(tiled.data(), 3, 16, back.data());
  EXPECT_EQ(back, numbers);
}

// Judges one output at one configuration, in place of what the row gives.
class Judge : public ::testing::Test {
 protected:
  Judge() {
    Batch batch(*Row("none/f64").energy);
    batch.Draw(*FindDistribution("active"), 1, 0, kTile);
    x_.assign(batch.X(0), batch.X(0) + 12);
    p_.assign(batch.P(0), batch.P(0) + 3);
  }

  RowFigures Of(const std::string& filter, const std::vector<double>& output,
                Depth depth = Depth::kTruth) {
    const KernelRow* const rows[] = {&Row(filter)};
    Examiner examiner(*rows[0]->energy, rows);
    const Packed outputs[] = {output};
    const std::vector<double> h = Exact("none/f64"), nearest = Exact("numeric/f64");
    examiner.Examine(x_.data(), p_.data(), h, nearest, outputs, depth);
    return examiner.Row(0);
  }
  std::vector<double> Exact(const std::string& filter) {
    std::vector<double> out(78);
    RunOne(Row(filter), x_.data(), p_.data(), out.data());
    return out;
  }
  std::vector<double> Scaled(const std::string& filter, double scale) {
    std::vector<double> out = Exact(filter);
    for (double& a : out) a *= scale;
    return out;
  }
  double Conditioning() const {
    return reference::FindEnergy<double>(kEnergy)->conditioning(x_.data(), p_.data());
  }

  std::vector<double> x_, p_;
};

TEST_F(Judge, PassesWhatIsRight) {
  const RowFigures f = Of("analytic/f64", Exact("analytic/f64"));
  EXPECT_EQ(f.verdict, Verdict::kPass);
  EXPECT_TRUE(f.broken.empty());
  EXPECT_TRUE(f.defined);
  EXPECT_LT(*f.rounding, 2);
  EXPECT_FALSE(*f.flip);
  EXPECT_LT(*f.psd_defect, 2);
  EXPECT_LT(*f.majorises, 12 * kUnit);
  EXPECT_GT(*f.distance, 1e-4);
  EXPECT_GT(*f.excess, 1);
  EXPECT_GT(*f.relabelling, 1e-4);
}

TEST_F(Judge, FindsNearestAtDistanceZeroWithExcessOne) {
  const RowFigures f = Of("numeric/f64", Exact("numeric/f64"));
  EXPECT_LT(*f.distance, 1e-14);
  EXPECT_NEAR(*f.excess, 1, 1e-12);
}

TEST_F(Judge, CallsNaNNonFinite) {
  std::vector<double> f = Exact("analytic/f64");
  f[5] = std::nan("");
  const RowFigures figures = Of("analytic/f64", f);
  EXPECT_EQ(figures.verdict, Verdict::kNonFinite);
  EXPECT_EQ(figures.broken, std::vector{Property::kFinite});
  EXPECT_FALSE(figures.distance);
}

TEST_F(Judge, CallsASilentZeroOne) {
  const RowFigures f = Of("analytic/f64", std::vector<double>(78));
  EXPECT_EQ(f.verdict, Verdict::kSilentZero);
  EXPECT_FALSE(f.broken.empty());
}

TEST_F(Judge, CallsTheHessianNonPsdWithoutABrokenPromise) {
  const RowFigures f = Of("none/f64", Exact("none/f64"));
  EXPECT_EQ(f.verdict, Verdict::kNonPsd);
  EXPECT_TRUE(f.broken.empty());
  EXPECT_EQ(Of("analytic/f64", Exact("none/f64")).verdict, Verdict::kNonPsd);
}

// A strand bent as at rest: mu grad theta grad theta^T and nothing else.
TEST(JudgeOfStrands, SeesThatAPsdHessianIsChanged) {
  KernelRow row = *FindKernel("strand/bend/quadratic/none/f64");
  row.exempt = {};
  const double x[9] = {1, 0, 0, 0, 0, 0, 0, 2, 0}, p[2] = {1, std::acos(-1.0) / 2};
  const KernelRow* const rows[] = {&row};
  Examiner examiner(*row.energy, rows);
  const auto breaks = [&] {
    examiner.Examine(x, p, Depth::kSpectral);
    EXPECT_FALSE(examiner.Configuration().indefinite);
    return std::ranges::count(examiner.Row(0).broken, Property::kKeepsPsd) > 0;
  };
  EXPECT_FALSE(breaks());
  row.run = [](const double* of, const double* with, double* out, long count) {
    FindKernel("strand/bend/quadratic/none/f64")->run(of, with, out, count);
    for (long i = 0; i < 45 * count; ++i) out[i] *= 0.9;
  };
  EXPECT_TRUE(breaks());
}

TEST_F(Judge, CallsWhatIsOffItsDefinitionDegraded) {
  for (Depth depth : {Depth::kDefinition, Depth::kSpectral, Depth::kTruth}) {
    const RowFigures figures = Of("analytic/f64", Scaled("analytic/f64", 1 + 1e-9), depth);
    EXPECT_EQ(figures.verdict, Verdict::kDegraded);
    EXPECT_EQ(figures.broken.front(), Property::kAccurate);
    EXPECT_NEAR(*figures.rounding * 12 * kUnit, 1e-9, 1e-12);
  }
  EXPECT_EQ(Of("analytic/f64", Scaled("analytic/f64", 1 + 1e-9), Depth::kCheap).verdict,
            Verdict::kPass);
  const double threshold = 1e-10 / Conditioning();  // docs/protocol.md, section 1
  for (const auto& [share, verdict] : {std::pair(0.9, Verdict::kPass), {1.1, Verdict::kDegraded}}) {
    EXPECT_EQ(Of("analytic/f64", Scaled("analytic/f64", 1 + share * threshold)).verdict, verdict);
  }
}

// In a thin triangle a rounding of x does what 1e-10 of the result amounts to.
TEST_F(Judge, HoldsAThinTriangleToTheBoundThatItsAngleAllows) {
  const auto spoilt = [&] { return Of("analytic/f64", Scaled("analytic/f64", 1 - 1e-10)); };
  EXPECT_NE(spoilt().broken, std::vector<Property>());
  x_ = {0.3, 0.2e-4, 0.05, 1, 0, 0, 0, 0, 0, 0.5, 1e-4, 0};
  const RowFigures f = spoilt();
  EXPECT_NEAR(Conditioning(), 2e-4, 1e-8);
  EXPECT_NEAR(*f.rounding * 12 * kUnit, 1e-10, 1e-12);
  EXPECT_DOUBLE_EQ(*f.conditioned_rounding, *f.rounding * Conditioning());
  EXPECT_GT(*f.majorises, 0);
  EXPECT_EQ(f.broken, std::vector<Property>());
  EXPECT_EQ(f.verdict, Verdict::kPass);
}

TEST_F(Judge, CallsAModeThatIsMissingAFlip) {
  EXPECT_TRUE(*Of("analytic/f64", Exact("gauss_newton/f64")).flip);
}

TEST_F(Judge, CallsGrowthBeyondFourTimesTheHessianDegraded) {
  const double norm = FrobeniusNorm(Exact("none/f64")) / FrobeniusNorm(Exact("analytic/f64"));
  for (const auto& [growth, verdict] :
       {std::pair(3.9, Verdict::kPass), {4.1, Verdict::kDegraded}}) {
    EXPECT_EQ(Of("analytic/f64", Scaled("analytic/f64", growth * norm), Depth::kCheap).verdict,
              verdict);
  }
}

TEST_F(Judge, SeesALossOfMajorisation) {
  const RowFigures figures = Of("analytic/f64", Scaled("analytic/f64", 0.5), Depth::kSpectral);
  EXPECT_GT(*figures.majorises, 0.01);
  EXPECT_NE(std::ranges::find(figures.broken, Property::kMajorises), figures.broken.end());
}

TEST_F(Judge, CallsAWrongGradientInconsistent) {
  EnergyRow energy = *Row("none/f64").energy;
  energy.gradient = [](const double*, const double*, double* out, long) {
    std::fill_n(out, 12, 1.0);
  };
  const KernelRow* const rows[] = {&Row("analytic/f64")};
  Examiner examiner(energy, rows);
  examiner.Examine(x_.data(), p_.data(), Depth::kTruth);
  EXPECT_EQ(examiner.Row(0).verdict, Verdict::kInconsistent);
}

TEST_F(Judge, CountsWhatIsOutsideTheDomain) {
  const std::vector<double> x = {0.2, 0.1, 0.3, 0, 0, 0, 1, 0, 0, 2, 0, 0}, p = {1, 1, 0};
  const KernelRow* const rows[] = {&Row("analytic/f64")};
  Examiner examiner(*rows[0]->energy, rows);
  examiner.Examine(x.data(), p.data(), Depth::kTruth);
  EXPECT_FALSE(examiner.Configuration().in_domain);
  EXPECT_EQ(examiner.Row(0).verdict, Verdict::kOutOfDomain);
}

TEST(CheckedPass, GivesTheSameBytesForAnyNumberOfThreads) {
  Progress progress(false);
  const std::string one = RowsOf(RunSweep(Plan(3001, 1), progress));
  EXPECT_EQ(one, RowsOf(RunSweep(Plan(3001, 2), progress)));
  EXPECT_EQ(one, RowsOf(RunSweep(Plan(3001, 7), progress)));
  SweepPlan other = Plan(3001, 2);
  other.seed = 43;
  EXPECT_NE(one, RowsOf(RunSweep(other, progress)));
}

TEST(CheckedPass, CountsEveryConfigurationOnce) {
  Progress progress(false);
  const SweepResult result = RunSweep(Plan(1003, 3), progress);
  for (const EnergyResult& energy : result.energies) {
    EXPECT_EQ(energy.statistics.count, 1003u);
    for (const RowResult& r : energy.rows) {
      std::uint64_t verdicts = 0;
      for (std::uint64_t n : r.statistics.verdicts) verdicts += n;
      EXPECT_EQ(verdicts, energy.statistics.active);
      EXPECT_EQ(r.statistics.defined + r.statistics.verdicts[3], energy.statistics.active);
    }
  }
}

TEST(CheckedPass, LooksAtNumericRowsWhereDefinitionsAre) {
  SweepPlan plan = Plan(1003, 2);
  plan.rows = {&Row("numeric/f64"), &Row("analytic/f64"), &Row("analytic/f64x8")};
  Progress progress(false);
  const SweepResult all = RunSweep(plan, progress);
  plan.samples = {
      .definition = 101, .spectrum = 11, .truth = 0};  // every tenth, not in whole tiles
  const SweepResult some = RunSweep(plan, progress);
  const auto looked_at = [](const SweepResult& result, std::size_t r) {
    std::uint64_t verdicts = 0;
    for (std::uint64_t n : result.energies[0].rows[r].statistics.verdicts) verdicts += n;
    return verdicts;
  };
  EXPECT_EQ(looked_at(all, 0), 1003u);
  EXPECT_EQ(looked_at(some, 0), 101u);
  EXPECT_EQ(some.energies[0].rows[0].statistics.defined, 101u);
  for (std::size_t r : {1u, 2u}) {
    EXPECT_EQ(looked_at(some, r), 1003u);
    EXPECT_EQ(some.energies[0].rows[r].statistics.checksum,
              all.energies[0].rows[r].statistics.checksum);
  }
  // What it is made of is right there, not just counted.
  const auto worst = some.energies[0].rows[0].statistics.distance.Summarize();
  EXPECT_LT(worst->max.value, 1e-9);
  EXPECT_EQ(some.energies[0].rows[0].statistics.verdicts[0], 101u);
}

TEST(CheckedPass, TakesTheNearestMatrixFromTheFastestRowThatIsNotJudged) {
  const auto nearest = [](std::vector<const KernelRow*> rows) {
    return &Examiner(*rows[0]->energy, rows).NearestRow();
  };
  EXPECT_EQ(nearest({&Row("analytic/f64")}), &Row("nearest/f64x8"));
  EXPECT_EQ(nearest({&Row("analytic/f64"), &Row("nearest/f64")}), &Row("numeric/f64"));
}

TEST(CheckedPass, CoversAPrefixWhenInterrupted) {
  Progress progress(false);
  std::thread interrupt([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    InterruptForTest(true);
  });
  const SweepResult partial = RunSweep(Plan(1'000'000, 2), progress);
  interrupt.join();
  InterruptForTest(false);
  EXPECT_TRUE(partial.partial);
  const std::uint64_t count = partial.energies[0].statistics.count;
  EXPECT_GT(count, 0u);
  EXPECT_LT(count, 1'000'000u);
  EXPECT_EQ(count % 256, 0u);
}

TEST(CheckedPass, LooksDeeperAtSamples) {
  const std::uint64_t n = 10'000'000;
  const auto seen = [&](const Samples& samples) {
    std::array<std::uint64_t, 3> counts{};
    for (std::uint64_t i = 0; i < n; ++i) {
      const Depth depth = DepthOf(i, n, samples);
      counts[0] += depth.definition;
      counts[1] += depth.spectrum;
      counts[2] += depth.truth;
    }
    return counts;
  };
  EXPECT_EQ(seen({}), (std::array<std::uint64_t, 3>{1'000'000, 100'000, 10'000}));
  EXPECT_EQ(seen({2'000, 50'000, 100}), (std::array<std::uint64_t, 3>{2'000, 50'000, 100}));
  EXPECT_EQ(DepthOf(0, 1), Depth::kTruth);
  EXPECT_EQ(DepthOf(1, 50), Depth::kDefinition);
}

TEST(CheckedPass, CoversTheConfigurationsOfSeveralPlans) {
  std::vector<SweepPlan> plans(2, Plan(300, 2));
  for (SweepPlan& plan : plans) {
    plan.rows = {FindKernel("collision/vertex_face/unsigned/quadratic/none/f64"),
                 FindKernel("collision/vertex_face/unsigned/quadratic/analytic/f64")};
  }
  plans[1].distribution = FindDistribution("normal");
  plans[1].overrides = {{"side", -1}, {"delta", 0.5}};
  plans[1].samples = {.definition = 10, .spectrum = 0, .truth = 0};
  Progress progress(false);
  const std::vector<SweepResult> results = RunSweeps(plans, progress);
  const auto json = ToJson(results, {"test"}, Detail::kBrief);
  ASSERT_EQ(json["rows"].size(), 2 * plans[0].rows.size());
  const auto &first = json["rows"][0], &last = json["rows"].back();
  EXPECT_EQ(first["distribution"], "active");
  EXPECT_FALSE(first.contains("set"));
  EXPECT_EQ(first["accuracy"]["relabelling"]["count"], 30);
  EXPECT_EQ(last["distribution"], "normal");
  EXPECT_EQ(last["set"].dump(), R"({"side":-1.0})");  // it has no delta
  EXPECT_EQ(last["active"], 300);                     // inside, all act
  EXPECT_EQ(last["accuracy"]["defined"], 10);
  EXPECT_TRUE(last["accuracy"]["relabelling"].is_null());
  EXPECT_TRUE(last["accuracy"]["distance"]["max"]["x"].is_null());
  EXPECT_TRUE(last["accuracy"]["rounding"].is_null());
  const auto whole = ToJson(results, {"test"}, Detail::kSummaries);
  EXPECT_EQ(whole["rows"].back()["accuracy"]["distance"]["max"]["x"].size(), 12u);
  EXPECT_EQ(whole["rows"].back()["accuracy"]["distance"]["max"]["p"][2], "-0x1p+0");
  EXPECT_EQ(ReplayCommand(plans[1], *plans[1].rows.back(), 7),
            "definite replay --kernel " + plans[1].rows.back()->name +
                " --distribution normal --seed 42 --index 7 --set side=-1");
}

TEST(Batch, SetsParametersBeforeItMirrors) {
  const EnergyRow& energy =
      *FindKernel("collision/vertex_face/signed/log_barrier/none/f64")->energy;
  const ParameterValue overrides[] = {{"side", -1}, {"k", 2}, {"no such", 7}};
  Batch drawn(energy), set(energy, overrides);
  drawn.Draw(*FindDistribution("active"), 3, 0, 64);
  set.Draw(*FindDistribution("active"), 3, 0, 64);
  for (std::int64_t i = 0; i < 64; ++i) {
    EXPECT_EQ(set.P(i)[0], 2);
    EXPECT_EQ(set.P(i)[1], 0.1);  // as drawn
    EXPECT_EQ(set.P(i)[2], -1);
    double classification[3];
    energy.classify(set.X(i), set.P(i), classification, 1);
    EXPECT_EQ(classification[1], 1);  // in the domain: on the side where it is defined now
    EXPECT_FALSE(std::equal(drawn.X(i), drawn.X(i) + 12, set.X(i)));
  }
}

TEST(Batch, TakesSomeConfigurationsAndFillsTheLastTileWithTheLast) {
  const EnergyRow& energy = AllEnergies()[0];
  Batch all(energy), some(energy);
  all.Draw(*FindDistribution("paper"), 3, 0, 16);
  const std::int64_t indices[] = {2, 3, 5, 7, 11, 13, 1, 8, 15};
  some.Take(all, indices);
  ASSERT_EQ(some.Size(), 16);
  for (std::int64_t i = 0; i < some.Size(); ++i) {
    const std::int64_t source = indices[std::min<std::int64_t>(i, 8)];
    for (int k = 0; k < energy.dofs; ++k) {
      EXPECT_EQ(some.X(i)[k], all.X(source)[k]);
      EXPECT_EQ(some.TilesX(8, i / 8 * 8)[k * 8 + i % 8], all.X(source)[k]);
    }
    EXPECT_EQ(some.P(i)[1], all.P(source)[1]);
  }
}

TEST(TimedPass, TimesEveryRowInEveryRound) {
  SweepPlan plan = Plan(20'000, 2);
  plan.timing = true;
  EnergyResult energy = Prepare(plan).energies[0];
  Progress progress(false);
  RunTimedPass(plan, energy, progress);
  EXPECT_GT(energy.timed_cpu, 0);
  EXPECT_GT(energy.timed_wall, 0);
  for (const RowResult& r : energy.rows) {
    for (const std::vector<double>& rounds : {r.timing.all, r.timing.active}) {
      EXPECT_EQ(rounds.size(), static_cast<std::size_t>(TimedRounds(plan.count)));
      for (double seconds : rounds) {
        EXPECT_GT(seconds, 0) << r.row->name;
        EXPECT_LT(seconds, 1) << r.row->name;
      }
    }
  }
}

TEST(Report, WritesNumbersForPeopleAndMachines) {
  EXPECT_EQ(WithCommas(7), "7");
  EXPECT_EQ(WithCommas(1000), "1,000");
  EXPECT_EQ(WithCommas(1234567), "1,234,567");
  for (double value : {0.1, -3.25, 0.0, 1e-310, 1e300}) {
    EXPECT_EQ(std::strtod(HexFloat(value).c_str(), nullptr), value) << HexFloat(value);
  }
  EXPECT_EQ(Duration(5.2), "5 s");
  EXPECT_EQ(Duration(65), "1 min 05 s");
  EXPECT_EQ(Duration(3700), "1 h 01 min");
}

TEST(Report, GivesAReplayLineForABrokenPromise) {
  Progress progress(false);
  SweepResult result = RunSweep(Plan(100, 1), progress);
  EXPECT_EQ(BrokenPromises(result), "");
  result.energies[0].rows[0].statistics.broken[Property::kPsd] = 17;
  const std::string lines = BrokenPromises(result);
  EXPECT_NE(lines.find("promises to be psd"), std::string::npos);
  EXPECT_NE(lines.find("--distribution active --seed 42 --index 17"), std::string::npos);
}

}  // namespace
}  // namespace definite
