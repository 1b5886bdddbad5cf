// Every check of `definite verify` accepts a sound energy and rejects a broken one.

#include "benchmarks/verify/verify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace definite::verify {
namespace {

// What the broken functions start from.
Subject sound;
const KernelRow* sound_row = nullptr;

// A subject with parts of its own, sound as yet.
struct Exhibit {
  EnergyRow energy;
  reference::Energy<Quad> reference;
  std::vector<KernelRow> rows;

  explicit Exhibit(const Subject& subject)
      : energy(*subject.energy), reference(*subject.reference) {
    for (const KernelRow* row : subject.rows) rows.push_back(*row);
    for (KernelRow& row : rows) row.energy = &energy;
  }
  Subject Of() const {
    Subject subject = {&energy, {}, &reference};
    for (const KernelRow& row : rows) subject.rows.push_back(&row);
    return subject;
  }
  // Puts in another function for the scalar row of a filter.
  void Replace(std::string_view filter, TileFunction run) {
    for (KernelRow& row : rows) {
      if (row.filter != filter || row.scalar != "f64") continue;
      sound_row = sound.Row(filter);
      row.run = run;
    }
  }
};

constexpr double kALittle = 1 + 1e-9;
const Quad kTiny = 1 + Quad(1e-20), kSmall = 1 + Quad(1e-14);

void TwistedValue(const double* x, const double* p, double* out, long tiles) {
  sound.energy->value(x, p, out, tiles);
  *out *= kALittle;
}
void SteepValue(const double* x, const double* p, double* out, long tiles) {
  sound.energy->value(x, p, out, tiles);
  *out *= 1.001;
}
void ValueOfM(const double* x, const double* p, double* out, long tiles) {
  sound.energy->value(x, p, out, tiles);
  *out *= 1 + 1e-9 * p[3];
}
void NeverActive(const double* x, const double* p, double* out, long tiles) {
  sound.energy->classify(x, p, out, tiles);
  *out = 0;
}
void LongGradient(const double* x, const double* p, double* out, long tiles) {
  sound.energy->gradient(x, p, out, tiles);
  for (int i = 0; i < sound.energy->dofs; ++i) out[i] *= kALittle;
}
void FarTooLongGradient(const double* x, const double* p, double* out, long tiles) {
  sound.energy->gradient(x, p, out, tiles);
  for (int i = 0; i < sound.energy->dofs; ++i) out[i] *= 1.001;
}
void GradientWithADraft(const double* x, const double* p, double* out, long tiles) {
  sound.energy->gradient(x, p, out, tiles);
  out[0] += 1e-300;
}
void StiffRow(const double* x, const double* p, double* out, long tiles) {
  sound_row->run(x, p, out, tiles);
  for (long k = 0; k < tiles * sound_row->outputs; ++k) out[k] *= kALittle;
}
void IndefiniteRow(const double* x, const double* p, double* out, long tiles) {
  sound_row->run(x, p, out, tiles);
  for (long t = 0; t < tiles; ++t) out[t * sound_row->outputs] -= 1e3;
}
// The second mode off its direction, and off its weight.
template <ModeTable EnergyRow::*kTable>
void TurnedMode(const double* x, const double* p, double* out, long tiles) {
  (sound.energy->*kTable).write(x, p, out, tiles);
  for (int k = 0; k < 3; ++k) out[(sound.energy->*kTable).size + 2 + k] += 1e-6;
}
template <ModeTable EnergyRow::*kTable>
void HeavyMode(const double* x, const double* p, double* out, long tiles) {
  (sound.energy->*kTable).write(x, p, out, tiles);
  out[(sound.energy->*kTable).size + 1] *= kALittle;
}
void TurnedFrameMode(const double* x, const double* p, double* out, long tiles) {
  const ModeTable& table = sound.energy->frame.front().modes;
  table.write(x, p, out, tiles);
  for (int k = 0; k < 3; ++k) out[2 * table.size + 1 - k] += 1e-6;
}
void HeavyFrameMode(const double* x, const double* p, double* out, long tiles) {
  const ModeTable& table = sound.energy->frame.front().modes;
  table.write(x, p, out, tiles);
  out[table.size + 1] *= kALittle;
}
void WideMap(const double* x, const double* p, double* out, long tiles) {
  sound.energy->frame.front().map(x, p, out, tiles);
  const int size = sound.energy->frame.front().modes.size * sound.energy->dofs;
  for (int k = 0; k < size; ++k) out[k] *= kALittle;
}
Quad TwistedReferenceValue(const Quad* x, const Quad* p) {
  return sound.reference->value(x, p) * kSmall;
}
reference::Derivatives<Quad> LongReferenceGradient(const Quad* x, const Quad* p) {
  auto derivatives = sound.reference->derivatives(x, p);
  for (Quad& entry : derivatives.gradient.entries) entry *= kSmall;
  return derivatives;
}
reference::Derivatives<Quad> NoReferenceGradient(const Quad* x, const Quad* p) {
  auto derivatives = sound.reference->derivatives(x, p);
  for (Quad& entry : derivatives.gradient.entries) entry = 0;
  return derivatives;
}
reference::Derivatives<Quad> StiffReferenceHessian(const Quad* x, const Quad* p) {
  auto derivatives = sound.reference->derivatives(x, p);
  for (Quad& entry : derivatives.hessian.entries) entry *= kTiny;
  return derivatives;
}
std::vector<reference::FrameTerm<Quad>> StiffReferenceFrame(const Quad* x, const Quad* p) {
  auto terms = sound.reference->frame(x, p);
  for (Quad& entry : terms.front().hessian.entries) entry *= kTiny;
  return terms;
}

struct Specimen {
  std::string_view check, energy;
  void (*spoil)(Exhibit& exhibit);
};

constexpr std::string_view kFace = "collision/vertex_face/signed/quadratic",
                           kFaceUnsigned = "collision/vertex_face/unsigned/quadratic",
                           kEdges = "collision/edge_edge/signed/quadratic",
                           kHybrid = "collision/edge_edge/hybrid/quadratic",
                           kFrozen = "collision/edge_edge/unsigned_frozen/quadratic",
                           kMixed = "collision/vertex_face/anisotropic/quadratic",
                           kMollified = "collision/edge_edge/mollified/quadratic",
                           kStrand = "strand/bend/quadratic";

void TwistValue(Exhibit& e) { e.energy.value = TwistedValue; }

const Specimen kSpecimens[] = {
    {"acts", kFace, [](Exhibit& e) { e.energy.classify = NeverActive; }},
    {"value", kStrand, TwistValue},
    {"gradient", kStrand, [](Exhibit& e) { e.energy.gradient = LongGradient; }},
    {"hessian", kFace, [](Exhibit& e) { e.Replace("none", StiffRow); }},
    {"value_differences", kFace, [](Exhibit& e) { e.energy.value = SteepValue; }},
    {"gradient_differences", kEdges, [](Exhibit& e) { e.energy.gradient = FarTooLongGradient; }},
    {"reference_gradient", kFace, [](Exhibit& e) { e.reference.value = TwistedReferenceValue; }},
    {"reference_hessian", kStrand,
     [](Exhibit& e) { e.reference.derivatives = LongReferenceGradient; }},
    {"frame_eigenpairs", kFace,
     [](Exhibit& e) { e.energy.frame.front().modes.write = TurnedFrameMode; }},
    {"frame_orthogonal", kFaceUnsigned,
     [](Exhibit& e) { e.energy.frame.front().modes.write = TurnedFrameMode; }},
    {"frame_complete", kMixed,
     [](Exhibit& e) { e.energy.frame.front().modes.write = HeavyFrameMode; }},
    {"split_eigenpairs", kEdges,
     [](Exhibit& e) { e.energy.split.write = TurnedMode<&EnergyRow::split>; }},
    {"split_orthogonal", kHybrid,
     [](Exhibit& e) { e.energy.split.write = TurnedMode<&EnergyRow::split>; }},
    {"split_complete", kFaceUnsigned,
     [](Exhibit& e) { e.energy.split.write = HeavyMode<&EnergyRow::split>; }},
    {"frame_terms", kFaceUnsigned, [](Exhibit& e) { e.energy.frame.front().map = WideMap; }},
    {"reference_terms", kMixed, [](Exhibit& e) { e.reference.frame = StiffReferenceFrame; }},
    {"chain_rule", kEdges, [](Exhibit& e) { e.reference.derivatives = StiffReferenceHessian; }},
    {"corrective_terms", kFaceUnsigned,
     [](Exhibit& e) { e.reference.derivatives = StiffReferenceHessian; }},
    {"first_corrective_term", kFaceUnsigned,
     [](Exhibit& e) { e.reference.derivatives = NoReferenceGradient; }},
    {"inertia", kEdges, [](Exhibit& e) { e.reference = *reference::FindEnergy<Quad>(kFrozen); }},
    {"unsigned_is_signed", kFaceUnsigned, TwistValue},
    {"hybrid_is_signed", kHybrid, TwistValue},
    {"hybrid_is_frozen", kHybrid, TwistValue},
    {"hybrid_curvature", kHybrid, [](Exhibit& e) { e.Replace("gauss_newton", StiffRow); }},
    {"hybrid_jump", kHybrid, TwistValue},
    {"frozen_gauss_newton", kFrozen, [](Exhibit& e) { e.Replace("analytic", StiffRow); }},
    {"m_1_is_signed", kMixed, TwistValue},
    {"m_drops_out", kMixed, [](Exhibit& e) { e.energy.value = ValueOfM; }},
    {"m_half_no_force", kMixed, [](Exhibit& e) { e.energy.gradient = GradientWithADraft; }},
    {"mollified_is_unsigned", kMollified, [](Exhibit& e) { e.Replace("nearest", StiffRow); }},
    {"frame_rows", kHybrid, [](Exhibit& e) { e.Replace("numeric_frame", StiffRow); }},
    {"rows_accurate", kStrand, [](Exhibit& e) { e.Replace("blend_half", StiffRow); }},
    {"rows_psd", kFace, [](Exhibit& e) { e.Replace("numeric", IndefiniteRow); }},
};

Subject Registered(std::string_view name) {
  std::vector<const KernelRow*> rows;
  for (const KernelRow& row : AllKernels()) {
    if (row.energy->name == name) rows.push_back(&row);
  }
  return SubjectOf(*rows.at(0)->energy, rows);
}

Plan PlanFor(const Subject& subject, int threads) {
  Plan plan;
  plan.subjects = {subject};
  for (const Distribution& distribution : AllDistributions()) {
    plan.distributions.push_back(&distribution);
  }
  plan.count = 48;
  plan.threads = threads;
  return plan;
}

Result RunOn(const Plan& plan) {
  Progress progress(false);
  return RunChecks(plan, progress);
}

// What one check finds over drawn configurations.
CheckResult Over(const Subject& subject, const Check& check) {
  Plan plan = PlanFor(subject, 1);
  plan.checks = std::span(&check, 1);
  return RunOn(plan).energies.at(0).checks.at(0);
}

class EveryCheck : public ::testing::TestWithParam<Specimen> {};

TEST_P(EveryCheck, AcceptsASoundEnergyAndRejectsABrokenOne) {
  const Specimen& specimen = GetParam();
  const auto check = std::ranges::find(AllChecks(), specimen.check, &Check::name);
  ASSERT_NE(check, AllChecks().end());
  sound = Registered(specimen.energy);
  ASSERT_TRUE(check->applies(sound));
  const CheckResult of_sound = Over(sound, *check);
  EXPECT_GE(of_sound.configurations, 5u);
  EXPECT_TRUE(of_sound.Passes()) << of_sound.worst->finding.violation;

  Exhibit exhibit(sound);
  specimen.spoil(exhibit);
  const CheckResult of_broken = Over(exhibit.Of(), *check);
  EXPECT_FALSE(of_broken.Passes()) << of_broken.worst->finding.violation;
}

INSTANTIATE_TEST_SUITE_P(Verify, EveryCheck, ::testing::ValuesIn(kSpecimens),
                         [](const auto& p) { return std::string(p.param.check); });

TEST(Verify, HasASpecimenOfEachCheck) {
  std::set<std::string_view> checks, specimens;
  for (const Check& check : AllChecks()) checks.insert(check.name);
  for (const Specimen& specimen : kSpecimens) specimens.insert(specimen.check);
  EXPECT_EQ(checks, specimens);
}

TEST(Verify, ANaNFails) {
  sound = Registered(kFace);
  Exhibit exhibit(sound);
  exhibit.energy.value = [](const double*, const double*, double* out, long) {
    *out = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_FALSE(Over(exhibit.Of(), *std::ranges::find(AllChecks(), "value", &Check::name)).Passes());
}

TEST(Verify, TheResultDoesNotDependOnTheNumberOfThreads) {
  const Subject subject = Registered(kFace);
  const std::string one = ToJson(RunOn(PlanFor(subject, 1)), {}).at("verification").dump();
  EXPECT_EQ(ToJson(RunOn(PlanFor(subject, 3)), {}).at("verification").dump(), one);
}

TEST(Verify, AFailureNamesTheConfigurationAndTheCommandThatReplaysIt) {
  sound = Registered(kFace);
  Exhibit exhibit(sound);
  exhibit.Replace("absolute", StiffRow);
  Plan plan = PlanFor(exhibit.Of(), 1);
  const Result result = RunOn(plan);
  const std::string failures = Failures(result);
  EXPECT_NE(failures.find("/absolute/f64: rows_accurate fails"), std::string::npos) << failures;
  const CheckResult& last = result.energies.at(0).checks.end()[-2];
  ASSERT_EQ(last.check->name, "rows_accurate");
  EXPECT_NE(failures.find("--distribution " + std::string(last.worst->distribution->name) +
                          " --seed 42 --index " + std::to_string(last.worst->index) + "\n"),
            std::string::npos)
      << failures;
  plan.distributions = {last.worst->distribution};
  plan.first = last.worst->index;
  plan.count = 1;
  EXPECT_NE(Failures(RunOn(plan)), "");
}

TEST(Verify, InterruptedItSaysThatItIsPartial) {
  InterruptForTest(true);
  const Result result = RunOn(PlanFor(Registered(kFace), 2));
  InterruptForTest(false);
  EXPECT_TRUE(result.partial);
  EXPECT_EQ(result.energies.at(0).drawn, 0u);
  EXPECT_EQ(Failures(result), "");
}

}  // namespace
}  // namespace definite::verify
