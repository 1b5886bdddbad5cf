// Every row of the registry against every property it promises, and every property against a
// broken filter that it must reject.

#include "tests/contracts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "all_filters.hpp"
#include "benchmarks/harness/examine.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/promises.hpp"
#include "tests/exhibits.hpp"
#include "tests/test_energies.hpp"

namespace definite::testing {
namespace {

// An energy of the tests' own, behind every filter: some of its Hessians are PSD, which those of
// the signed collision energies never are.
const std::vector<EnergyTable>& TestTables() {
  static const std::vector<EnergyTable> tables = [] {
    std::vector<EnergyTable> t = {MakeTable<TriangleArap>(AllFilters())};
    for (EnergyTable& table : t) {
      for (KernelRow& row : table.kernels) row.energy = &table.energy;
    }
    return t;
  }();
  return tables;
}

std::vector<Subject> Subjects() {
  std::vector<KernelRow const*> rows;
  for (const KernelRow& row : AllKernels()) rows.push_back(&row);
  for (const EnergyTable& table : TestTables()) {
    for (const KernelRow& row : table.kernels) rows.push_back(&row);
  }
  std::vector<Subject> subjects;
  for (const KernelRow* row : rows) {
    Subject s{row, nullptr, nullptr};
    for (const KernelRow* other : rows) {
      if (other->energy != row->energy || other->scalar != "f64") continue;
      if (other->filter == "none") s.exact = other;
      if (other->filter == row->filter) s.scalar = other;
    }
    subjects.push_back(s);
  }
  return subjects;
}

struct Promise {
  Subject subject;
  Property property;
};

std::vector<Promise> Promises() {
  std::vector<Promise> promises;
  for (const Subject& subject : Subjects()) {
    for (Property property : kProperties) {
      if (property == Property::kAccurate) continue;  // of all rows at once, below
      if (subject.row->Promises(property)) promises.push_back({subject, property});
    }
  }
  return promises;
}

void PrintTo(const Promise& promise, std::ostream* out) {
  *out << promise.subject.row->name << " " << PropertyName(promise.property);
}

class Contract : public ::testing::TestWithParam<Promise> {};

TEST_P(Contract, IsKept) {
  const auto& [subject, property] = GetParam();
  const bool accurate = subject.row->Promises(Property::kAccurate);
  int checked = 0;
  for (const Configuration& c : Configurations(*subject.row->energy)) {
    // A filter that is not accurate everywhere is held to the rest where it is.
    if (!accurate && !c.well_conditioned) continue;
    EXPECT_LE(Violation(property, subject, c), 1) << c.name;
    ++checked;
  }
  EXPECT_GE(checked, 20);
}

std::string WithUnderscores(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Registry, Contract, ::testing::ValuesIn(Promises()), [](const auto& test) {
  const Promise& promise = test.param;
  return WithUnderscores(promise.subject.row->name + "_" +
                         std::string(PropertyName(promise.property)));
});

class AccurateRows : public ::testing::TestWithParam<const EnergyRow*> {};

TEST_P(AccurateRows, AreAccurate) {
  std::vector<const KernelRow*> rows;
  for (const KernelRow& row : AllKernels()) {
    if (row.energy == GetParam() && row.Promises(Property::kAccurate)) rows.push_back(&row);
  }
  const std::vector<Configuration> configurations = Configurations(*GetParam());
  EXPECT_GE(rows.size(), 6);
  EXPECT_GE(configurations.size(), 20);
  for (const Configuration& c : configurations) {
    const std::vector<double> violations = AccuracyViolations(rows, c);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      EXPECT_LE(violations[r], 1) << rows[r]->name << " at " << c.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, AccurateRows, ::testing::ValuesIn([] {
                           std::vector<const EnergyRow*> energies;
                           for (const EnergyRow& energy : AllEnergies()) {
                             energies.push_back(&energy);
                           }
                           return energies;
                         }()),
                         [](const auto& test) { return WithUnderscores(test.param->name); });

// The greatest violation over all configurations of a broken row.
double WorstViolation(Property property, const KernelRow& row, const KernelRow* exact,
                      const KernelRow* scalar) {
  double worst = 0;
  for (const Configuration& c : Configurations(*row.energy)) {
    worst = std::max(worst, Violation(property, {&row, exact, scalar}, c));
  }
  return worst;
}

class Exhibits : public ::testing::Test {
 protected:
  Exhibits() : table_(MakeTable<Collision<Signed<VertexFace>, Quadratic>>(BrokenFilters())) {
    energy_ = FindKernel("collision/vertex_face/signed/quadratic/none/f64")->energy;
    for (KernelRow& row : table_.kernels) row.energy = energy_;
  }

  // The exhibits come in the order of BrokenFilters, scalars first.
  void ExpectRejected(Property property, std::size_t exhibit, bool lanes = false) {
    const std::size_t count = table_.kernels.size() / 2;
    const KernelRow& row = table_.kernels[exhibit + (lanes ? count : 0)];
    EXPECT_GT(WorstViolation(property, row, Exact(), &table_.kernels[exhibit]), 1);
    EXPECT_TRUE(IsSeenToBreak(property, row, table_.kernels[exhibit])) << "by the judge";
  }
  // By the judge of sweeps and hunts.
  bool IsSeenToBreak(Property property, const KernelRow& row, const KernelRow& scalar) const {
    const KernelRow* const rows[] = {&scalar, &row};
    Examiner examiner(*energy_, rows);
    return std::ranges::any_of(Configurations(*energy_), [&](const Configuration& c) {
      examiner.Examine(c.x.data(), c.p.data(), Depth::kSpectral);
      return std::ranges::count(examiner.Row(1).broken, property) > 0;
    });
  }
  const KernelRow* Exact() const {
    return FindKernel("collision/vertex_face/signed/quadratic/none/f64");
  }

  EnergyTable table_;
  const EnergyRow* energy_;
};

TEST_F(Exhibits, DivisionByTheLengthIsNotFinite) { ExpectRejected(Property::kFinite, 0); }
TEST_F(Exhibits, ALittleLeftNegativeIsNotPsd) { ExpectRejected(Property::kPsd, 1); }
TEST_F(Exhibits, AShortConstantIsNotAccurate) { ExpectRejected(Property::kAccurate, 2); }
TEST_F(Exhibits, OtherRoundingOnLanesIsNotEqual) {
  ExpectRejected(Property::kLanesEqualScalar, 3, true);
}
TEST_F(Exhibits, TenPercentLessDoesNotMajorise) { ExpectRejected(Property::kMajorises, 4); }
TEST_F(Exhibits, APreferredAxisDoesNotTurnWithThePair) {
  ExpectRejected(Property::kRigidMotion, 5);
}
TEST_F(Exhibits, AVertexTiedDownFeelsTranslation) { ExpectRejected(Property::kTranslation, 6); }
TEST_F(Exhibits, AnAbsoluteThresholdFeelsTheUnit) { ExpectRejected(Property::kScale, 7); }

TEST_F(Exhibits, ThePapersFilterFeelsTheNumbering) {
  EXPECT_GT(WorstViolation(Property::kRelabelling,
                           *FindKernel("collision/vertex_face/signed/quadratic/analytic/f64"),
                           Exact(), nullptr),
            1);
}

// The triangle's Hessian is PSD in some shapes; otherwise keeps_psd would be vacuous.
TEST(Exhibit, GaussNewtonDoesNotKeepPsdMatrices) {
  const EnergyTable& table = TestTables()[0];
  const auto row = std::ranges::find(table.kernels, "gauss_newton", &KernelRow::filter);
  const auto exact = std::ranges::find(table.kernels, "none", &KernelRow::filter);
  int psd = 0, indefinite = 0;
  for (const Configuration& c : Configurations(table.energy)) {
    ++(IsPsd(Outputs(*exact, c.x, c.p)) ? psd : indefinite);
  }
  EXPECT_GE(psd, 3);
  EXPECT_GE(indefinite, 3);
  EXPECT_GT(WorstViolation(Property::kKeepsPsd, *row, &*exact, nullptr), 1);
}

}  // namespace
}  // namespace definite::testing
