// Each row against its definition in float128: a small sample of what a sweep looks at.

#include <algorithm>
#include <cmath>

#include "benchmarks/harness/neighbours.hpp"
#include "benchmarks/verify/check.hpp"

namespace definite::verify {

namespace {

// The scalar row of the same filter where it gave the same bits: no need to look twice.
bool IsTwin(Case& at, const KernelRow& row) {
  if (row.lanes == 1) return false;
  return std::ranges::any_of(at.Of().rows, [&](const KernelRow* other) {
    return other->lanes == 1 && other->filter == row.filter && at.Output(*other) == at.Output(row);
  });
}

// What a row that exempts itself from accuracy rounds in units of.
Quad ExemptScale(Case& at) {
  return FrobeniusNorm(at.Truth().Hessian()) + FrobeniusNorm(at.Definition("absolute"));
}

// The unit roundoff of what a row computes in, over u.
double RoundoffOf(const KernelRow& row) { return row.filter == "numeric_float" ? 0x1p29 : 1; }

// What the digits of the input leave open, in units of the bound.
Quad Open(Case& at, const KernelRow& row) {
  const double open = Neighbours(at.Energy(), *at.Of().reference, at.X().data(), at.P().data())
                          .Change(*reference::FindFilter<Quad>(row.filter), at.Truth());
  return open / (kRatioBound * at.Energy().dofs * kUnit) * at.Conditioning();
}

std::optional<Finding> Accuracy(Case& at) {
  std::optional<Finding> worst;
  for (const KernelRow* row : at.Of().rows) {
    if (IsTwin(at, *row)) continue;
    const Matrix& definition = at.Definition(row->filter);
    Quad scale = FrobeniusNorm(definition);
    if (!row->Promises(Property::kAccurate)) scale += ExemptScale(at);
    const Quad error = FrobeniusNorm(Unpacked(at.Output(*row)) - definition);
    double violation = at.Ratio(error, scale) / RoundoffOf(*row);
    // Where the positive part of a Hessian is little, few of its digits are in those of the input.
    if (violation > 1) violation = at.Ratio(error, scale + Open(at, *row)) / RoundoffOf(*row);
    if (!row->Promises(Property::kFinite)) {
      // The printed formulas lose digits like u/|l| and u/sin^2 on top.
      const double x = static_cast<double>(FrobeniusNorm(ToVector(at.X())));
      violation *= at.Conditioning() * std::pow(std::min(1.0, std::abs(at.Length()) / x), 2);
    }
    worst = Worse(worst, Finding{violation, row});
  }
  return worst;
}

std::optional<Finding> Definiteness(Case& at) {
  std::optional<Finding> worst;
  for (const KernelRow* row : at.Of().rows) {
    // What promises neither is none and the printed formulas.
    const bool promises = row->Promises(Property::kPsd);
    if ((!promises && !row->filter.starts_with("numeric")) || IsTwin(at, *row)) continue;
    const Numbers& f = at.Output(*row);
    Quad scale = FrobeniusNorm(f);
    if (!promises) scale += ExemptScale(at);
    const double defect = std::max(0.0, -Eigenvalues(f).front()) / RoundoffOf(*row);
    worst = Worse(worst, Finding{defect == 0 ? 0
                                             : defect / (kRatioBound * at.Energy().dofs * kUnit *
                                                         static_cast<double>(scale)),
                                 row});
  }
  return worst;
}

}  // namespace

std::vector<Check> RowChecks() {
  return {
      {"rows_accurate", "each row is its filter's definition in float128", AppliesToAll, Accuracy},
      {"rows_psd", "each row that projects is PSD", AppliesToAll, Definiteness},
  };
}

}  // namespace definite::verify
