// The engine of the scenes: derivatives, identities, intervals, and that nothing hangs on threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/harness/progress.hpp"
#include "scenes/cables.hpp"
#include "scenes/report.hpp"
#include "scenes/slopes.hpp"

namespace definite::scenes {
namespace {

Draws DrawsOf(std::uint64_t start) { return Draws(StreamId("scenes_test"), 5, start); }

// Two crossed cables, 3 segments each, bent, pressed to a length of about level * eps.
Trial CrossedCables(const std::string& length, const std::string& filter, double level,
                    std::uint64_t start) {
  Cables cables;
  cables.gap = level * cables.eps;
  cables.bending = 0.001;
  cables.rest = 0.9;
  cables.memory = Memory::kScene;
  cables.noise = 0.02 * cables.eps;
  Draws draws = DrawsOf(start);
  Trial trial = MakeCables(cables, {length, filter, 1, 1, 0, ""}, draws);
  // Bent: a straight strand is outside the domain of bending.
  for (int v = 0; v < trial.model.Size(); ++v) {
    double& z = trial.model.x[static_cast<std::size_t>(3 * v + 2)];
    const bool is_end = trial.model.scripted[static_cast<std::size_t>(v)];
    z += is_end ? (v < trial.model.Size() / 2 ? -0.1 : 0.1) : 0;
  }
  trial.method.elastic_filter = "none";
  return trial;
}

double Norm(const std::vector<double>& v) {
  double sum = 0;
  for (const double a : v) sum += a * a;
  return std::sqrt(sum);
}

struct Errors {
  double gradient = 0, hessian = 0;
  std::size_t contacts = 0;
};

// Central differences of the value and of the gradient against what is assembled.
Errors AgainstDifferences(const Trial& trial) {
  constexpr double kStep = 1e-5;
  const std::vector<double>& x = trial.model.x;
  const auto assembled = [&](const std::vector<double>& at) {
    SideMemory memory;
    return Assemble(trial.model, trial.method, at, memory);
  };
  const Assembled here = assembled(x);
  std::vector<double> gradient(x.size()), hessian(x.size() * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::vector<double> above = x, below = x;
    above[i] += kStep;
    below[i] -= kStep;
    const Assembled up = assembled(above), down = assembled(below);
    gradient[i] = (up.value - down.value) / (2 * kStep) - here.gradient[i];
    for (std::size_t j = 0; j < x.size(); ++j) {
      hessian[i * x.size() + j] =
          (up.gradient[j] - down.gradient[j]) / (2 * kStep) - here.hessian[i * x.size() + j];
    }
  }
  SideMemory memory;
  return {Norm(gradient) / Norm(here.gradient), Norm(hessian) / Norm(here.hessian),
          ContactsAt(trial.model.contacts, x, memory).vertices.size() / 4};
}

TEST(Assembly, AgreesWithDifferences) {
  for (const char* length : {"signed", "unsigned", "hybrid"}) {
    for (const double level : {0.5, -0.4}) {
      for (std::uint64_t start = 0; start < 10; ++start) {
        const Errors errors = AgainstDifferences(CrossedCables(length, "none", level, start));
        EXPECT_GE(errors.contacts, 1u) << length;
        EXPECT_LT(errors.gradient, 1e-8) << length << level << start;
        EXPECT_LT(errors.hessian, 1e-7) << length << level << start;
      }
    }
  }
  Draws draws = DrawsOf(0);
  Trial slope = VertexOnSlope({"signed", "none", 1, 1, 0, ""}, draws);
  const Errors errors = AgainstDifferences(slope);
  EXPECT_EQ(errors.contacts, 1u);
  EXPECT_LT(errors.gradient, 1e-6);  // edges of 100 m, differences of 1e-5 m
}

// design of the scenes: "none" of unsigned edges is the Hessian of frozen parameters, not the
// exact.
TEST(Assembly, FrozenEdgesAreNotTheirOwnHessian) {
  const Errors errors = AgainstDifferences(CrossedCables("unsigned_frozen", "none", 0.5, 1));
  EXPECT_LT(errors.gradient, 1e-8);
  EXPECT_GT(errors.hessian, 1e-3);
}

// The Hessian of the contacts alone.
std::vector<double> ContactHessian(const std::string& length, const std::string& filter,
                                   double level, Memory memory_kind, std::uint64_t start) {
  Trial trial = CrossedCables(length, filter, level, start);
  trial.model.elastic.clear();
  trial.model.contacts.memory = memory_kind;
  SideMemory memory;
  return Assemble(trial.model, trial.method, trial.model.x, memory).hessian;
}

double Distance(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return Norm(difference) / Norm(b);
}

TEST(Identities, FrozenEdgesOutsideLoseNothingToGaussNewton) {
  for (std::uint64_t start = 0; start < 20; ++start) {
    const auto of = [&](const char* filter, double level, Memory memory) {
      return ContactHessian("unsigned_frozen", filter, level, memory, start);
    };
    EXPECT_LT(
        Distance(of("analytic", 0.5, Memory::kScene), of("gauss_newton", 0.5, Memory::kScene)),
        1e-15);
    // Penetrating ones do, unless nothing remembers that they do.
    EXPECT_GT(
        Distance(of("analytic", -0.4, Memory::kScene), of("gauss_newton", -0.4, Memory::kScene)),
        0.1);
    EXPECT_LT(
        Distance(of("analytic", -0.4, Memory::kNone), of("gauss_newton", -0.4, Memory::kNone)),
        1e-15);
  }
}

TEST(Identities, GaussNewtonOfTheHybridIsThatOfTheUnsigned) {
  for (const double level : {0.5, -0.4}) {
    for (std::uint64_t start = 0; start < 20; ++start) {
      EXPECT_LT(
          Distance(ContactHessian("hybrid", "gauss_newton", level, Memory::kScene, start),
                   ContactHessian("unsigned_frozen", "gauss_newton", level, Memory::kScene, start)),
          1e-14);
    }
  }
}

TEST(Step, IsAFreeFallWithoutContact) {
  Draws draws = DrawsOf(3);
  Trial trial = VertexOnSlope({"signed", "analytic", 1, 1, 0, ""}, draws);
  trial.model.contacts.vertices.clear();
  trial.model.contacts.orientation.clear();
  State state{trial.model.x, trial.model.v, 0, {}};
  const double before = state.x[2];
  for (int i = 0; i < 10; ++i) Advance(trial.model, trial.method, 0.1, state);
  EXPECT_NEAR(state.x[2] - before, -9.81 * 0.01 * 10 * 11 / 2, 1e-12);
}

// Along its axis a damped spring is linear: backward Euler's answer is known, its other end moves
// as scripted, and further iterations have nothing to add.
TEST(Step, SolvesALinearSpringExactly) {
  for (const int iterations : {1, 3}) {
    Trial trial;
    Model& model = trial.model;
    model.AddVertex({0, 0, 0}, 1, true, {0.2, 0, 0});
    model.AddVertex({1.1, 0, 0}, 0.5);
    model.script_end = 0.5;
    model.elastic = {{"strand/stretch/quadratic", {0, 1}, {3.0, 1.0}}};
    trial.method.rayleigh = 0.01;
    trial.method.iterations = iterations;
    State state{model.x, model.v, 0, {}};
    const double dt = 0.02, k = 3, m = 0.5, c = 0.01 * k;
    double end = 0, x = 1.1, v = 0;
    for (int i = 0; i < 50; ++i) {
      const StepReport report = Advance(model, trial.method, dt, state);
      EXPECT_EQ(report.negative_pivots, 0);
      const double moved = i < 25 ? 0.2 * dt : 0;
      // (m/dt^2 + c/dt + k) dx = m v/dt - k (x - end - 1) + (c/dt + k) moved
      const double dx =
          (m * v / dt - k * (x - end - 1) + (c / dt + k) * moved) / (m / (dt * dt) + c / dt + k);
      end += moved;
      x += dx;
      v = dx / dt;
      EXPECT_NEAR(state.x[0], end, 1e-13);
      EXPECT_NEAR(state.x[3], x, 1e-13) << i;
    }
  }
}

TEST(Step, MovesScriptedVerticesAsTheScriptSays) {
  Trial trial = CrossedCables("signed", "analytic", 1.2, 0);
  State state{trial.model.x, trial.model.v, 0, {}};
  for (int i = 0; i < 40; ++i) Advance(trial.model, trial.method, kFrame, state);
  EXPECT_NEAR(state.x[2] - trial.model.x[2], -Cables().displacement, 1e-12);
}

TEST(Step, CountsNegativePivotsOfWhatIsIndefinite) {
  for (const auto& [filter, least, most] :
       {std::tuple("none", 1, 24), std::tuple("analytic", 0, 0), std::tuple("on_demand", 0, 0),
        std::tuple("progressive", 0, 0)}) {
    Trial trial = CrossedCables("unsigned_frozen", filter, 0.2, 1);
    trial.method.elastic_filter = "analytic";
    for (double& mass : trial.model.mass) mass *= 1e-3;
    State state{trial.model.x, trial.model.v, 0, {}};
    const StepReport report = Advance(trial.model, trial.method, kFrame, state);
    EXPECT_GE(report.negative_pivots, least) << filter;
    EXPECT_LE(report.negative_pivots, most) << filter;
    EXPECT_EQ(report.first_negative > 0, filter[0] != 'a') << filter;
    EXPECT_EQ(report.factorizations > 1, filter[0] == 'o' || filter[0] == 'p') << filter;
  }
}

TEST(Step, ConvergesWithALineSearch) {
  Trial trial = CrossedCables("unsigned", "nearest", 0.9, 2);
  trial.method.elastic_filter = "analytic";
  trial.method.iterations = 50;
  trial.method.line_search = true;
  State state{trial.model.x, trial.model.v, 0, {}};
  for (int i = 0; i < 10; ++i) {
    const StepReport report = Advance(trial.model, trial.method, kFrame, state);
    EXPECT_TRUE(report.solved);
    EXPECT_LT(report.newton_iterations, 50) << i;
    EXPECT_TRUE(report.converged);
  }
}

TEST(Resonance, IsWhereItIsPredicted) {
  const Scene& scene = *FindScene("resonance");
  for (const double level : {0.3, 0.5, 0.7}) {
    const Case c{"unsigned_frozen", "none", 1, 1, level, ""};
    EXPECT_NEAR(scene.run(c, 11, 0, nullptr)[Figure::kPeak], 1, 0.01) << level;
  }
}

TEST(Slip, IsTheDistanceTimesTheSlope) {
  const Scene& scene = *FindScene("tilted_edge");
  const Case c{"unsigned_frozen", "analytic", 1, 1, -0.3, ""};
  EXPECT_NEAR(scene.run(c, 11, 0, nullptr)[Figure::kSlip], 1, 1e-3);
}

TEST(Prediction, CorrelatesRanks) {
  EXPECT_DOUBLE_EQ(RankCorrelation({1, 2, 3, 4}, {0.1, 7, 8, 1e9}), 1);
  EXPECT_DOUBLE_EQ(RankCorrelation({1, 2, 3}, {3, 2, 1}), -1);
  // Ranks (0.5, 0.5, 2) and (0, 1.5, 1.5).
  EXPECT_DOUBLE_EQ(RankCorrelation({5, 5, 9}, {1, 2, 2}), 0.5);
  EXPECT_TRUE(std::isnan(RankCorrelation({1, 1, 1}, {1, 2, 3})));
}

TEST(Prediction, HasTheErrorsOfRowsOnContactsMet) {
  const Scene& scene = *FindScene("cables_popping");
  Plan plan;
  plan.starts = 2;
  std::vector<CaseResult> map;
  for (const char* filter : {"nearest", "numeric", "analytic", "none", "on_demand"}) {
    Case c = scene.contrast().front();
    c.length = "signed";
    c.filter = filter;
    map.push_back({c, std::vector<Outcome>(plan.starts)});
  }
  const auto errors = *ErrorsOf(scene, map, plan);
  ASSERT_TRUE(errors[0] && errors[1] && errors[2] && errors[3]);
  EXPECT_FALSE(errors[4]);  // no row
  EXPECT_GT(errors[0]->contacts, 20u);
  EXPECT_EQ(errors[0]->distance, 0);
  EXPECT_EQ(errors[0]->step_error, 0);
  EXPECT_LT(errors[1]->distance, 1e-12);
  EXPECT_LT(errors[1]->step_error, 1e-12);
  EXPECT_GT(errors[2]->distance, 1e-4);
  EXPECT_GT(errors[3]->distance, errors[2]->distance);
  EXPECT_GT(errors[3]->step_error, errors[2]->step_error);
}

TEST(Intervals, AreThoseOfTheLiterature) {
  // Wilson: 15 of 148; Newcombe: 56/70 against 48/80, 0.2 [0.0524, 0.3339].
  const Interval wilson = WilsonInterval(15, 148);
  EXPECT_NEAR(wilson.low, 0.0624, 1e-4);
  EXPECT_NEAR(wilson.high, 0.1605, 1e-4);
  const Interval newcombe = DifferenceInterval(48, 80, 56, 70);
  EXPECT_NEAR(newcombe.low, 0.0524, 1e-4);
  EXPECT_NEAR(newcombe.high, 0.3339, 1e-4);
  EXPECT_EQ(WilsonInterval(0, 40).low, 0);
  EXPECT_EQ(WilsonInterval(40, 40).high, 1);
  // Fisher's tea: 3 of 4 against 1 of 4.
  EXPECT_NEAR(FisherTest(3, 4, 1, 4), 0.4857, 1e-4);
  EXPECT_NEAR(FisherTest(13, 40, 2, 40), 0.0033, 2e-4);
  EXPECT_EQ(FisherTest(0, 40, 0, 40), 1);
}

TEST(Intervals, OfPairsAreNarrowWherePairsAgree) {
  std::vector<bool> half(100), other(100);
  for (std::size_t i = 0; i < half.size(); ++i) half[i] = i % 2 == 0;
  for (std::size_t i = 0; i < half.size(); ++i) other[i] = i % 2 != 0;
  const Interval same = PairedInterval(half, half), opposite = PairedInterval(half, other);
  EXPECT_LT(same.high - same.low, 0.05);
  EXPECT_GT(opposite.high - opposite.low, 0.3);
  EXPECT_NEAR(same.low, -same.high, 1e-12);
}

TEST(Runs, AreTheSameForAnyNumberOfThreads) {
  for (const Scene& scene : AllScenes()) {
    const std::vector<Case> contrast = scene.contrast();
    Plan plan{9, 3, 1, {}, [] {}};
    const auto one = RunCases(scene, contrast, plan);
    plan.threads = 3;
    const auto three = RunCases(scene, contrast, plan);
    for (std::size_t i = 0; i < contrast.size(); ++i) {
      for (std::size_t s = 0; s < 3; ++s) {
        const auto &a = (*one)[i].starts[s].of, &b = (*three)[i].starts[s].of;
        EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof a), 0) << scene.name;
      }
    }
  }
}

TEST(Runs, EndWithAVerdictWhereTheyExplode) {
  const Scene& scene = *FindScene("cables_unfiltered");
  Plan plan{9, 20, 2, {}, [] {}};
  const auto runs = RunCases(scene, {{"unsigned_frozen", "none", 0.3, 1, 0, ""}}, plan);
  EXPECT_GT(runs->front().Count(Figure::kBooms), 0u);
  Reported reported{&scene, {}, {}, *runs, {std::nullopt}};
  const std::string text = ToJson(plan, 1, {reported}).dump();
  EXPECT_EQ(text.find("nan"), text.npos);
  EXPECT_EQ(text.find("inf"), text.npos);
  EXPECT_EQ(runs->front().Count(Figure::kFails), 20u);
}

TEST(Runs, StopWhenInterrupted) {
  InterruptForTest(true);
  EXPECT_FALSE(RunScene(*FindScene("tilted_edge"), Plan{}));
  InterruptForTest(false);
}

// Without the memory of sides both filters let the cables through.
TEST(Popping, NeedsTheMemoryOfSides) {
  const Scene& scene = *FindScene("cables_popping");
  Plan plan{9, 10, 2, {}, [] {}};
  const auto ran = RunCases(scene,
                            {{"unsigned_frozen", "analytic", 10, 1, 0, "side_memory"},
                             {"unsigned_frozen", "analytic", 10, 1, 0, ""}},
                            plan);
  EXPECT_EQ((*ran)[0].Count(Figure::kPops), 10u);
  EXPECT_EQ((*ran)[1].Count(Figure::kPops), 0u);
}

TEST(Scenes, ChangeNothingButWhatIsAsked) {
  for (const Scene& scene : AllScenes()) {
    for (const Change& change : scene.changes()) {
      Case c = scene.contrast().front();
      c.change = change.name;
      EXPECT_NO_THROW(scene.make(c, 1, 0)) << scene.name << change.name;
    }
    Case c = scene.contrast().front();
    c.change = "nothing";
    EXPECT_THROW(scene.make(c, 1, 0), std::runtime_error) << scene.name;
  }
}

}  // namespace
}  // namespace definite::scenes
