// Value, gradient and Hessian: the kernel's against the reference's automatic differentiation, and
// both against central differences.

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/verify/check.hpp"

namespace definite::verify {

namespace {

Quad NormOf(const Numbers& v) { return FrobeniusNorm(ToVector(v)); }

// How far rounding x moves the value and the gradient, in units of u.
Quad ValueScale(Case& at) {
  return abs(at.Truth().Value()) + FrobeniusNorm(at.Truth().Gradient()) * NormOf(at.X());
}
Quad GradientScale(Case& at) {
  return FrobeniusNorm(at.Truth().Gradient()) +
         FrobeniusNorm(at.Truth().Hessian()) * NormOf(at.X());
}

// Whether rounding x cannot move a length across eps or 0, where the energy begins and ends to act.
bool IsDecided(const Case& at) {
  if (!HasPart(at.Energy().name, "collision")) return true;
  const double slack = kRatioBound * kUnit * static_cast<double>(NormOf(at.X()));
  const double length = at.Length();
  return std::abs(length) > slack && std::abs(length - at.P()[1]) > slack;
}

std::optional<Finding> Activity(Case& at) {
  if (!IsDecided(at)) return std::nullopt;
  const bool active = at.Active();
  const bool agrees =
      active == at.Truth().Active() && (active || (at.Value() == 0 && AllZero(at.Gradient())));
  return Finding{agrees ? 0 : std::numeric_limits<double>::infinity()};
}

std::optional<Finding> ValueError(Case& at) {
  return Finding{at.Ratio(at.Value() - at.Truth().Value(), ValueScale(at))};
}

Matrix GradientDifference(Case& at) { return ToVector(at.Gradient()) - at.Truth().Gradient(); }

std::optional<Finding> GradientError(Case& at) {
  return Finding{at.Ratio(FrobeniusNorm(GradientDifference(at)), GradientScale(at))};
}

std::optional<Finding> HessianError(Case& at) {
  return Finding{at.Ratio(FrobeniusNorm(at.Hessian() - at.Truth().Hessian()),
                          FrobeniusNorm(at.Truth().Hessian()))};
}

// The unit vector along v; along the first axis where v is zero.
Numbers Direction(const Matrix& v) {
  Numbers d = ToDouble(v);
  const double norm = static_cast<double>(NormOf(d));
  if (!(norm > 0)) d[0] = 1;
  for (double& entry : d) entry /= norm > 0 ? norm : 1;
  return d;
}

// Where the gradient is worst, and where the Hessian is: the top eigenvector of what it is off by.
Numbers WorstOfGradient(Case& at) { return Direction(GradientDifference(at)); }
Numbers WorstOfHessian(Case& at) {
  const Matrix difference = at.Hessian() - at.Truth().Hessian();
  reference::Matrix<double> in_double(difference.rows, difference.cols);
  in_double.entries = ToDouble(difference);
  const reference::Spectrum<double> spectrum = reference::EigenSpectrum(in_double);
  const int last = difference.rows - 1;
  const int top = std::abs(spectrum.values[0]) > std::abs(spectrum.values[last]) ? 0 : last;
  Matrix vector(difference.rows, 1);
  for (int i = 0; i < difference.rows; ++i) vector[i] = spectrum.vectors(i, top);
  return Direction(vector);
}

// Derivatives hold the closest points still there, so they are not those of the gradient.
bool HoldsClosestPoints(const Case& at) {
  return at.Is("unsigned_frozen") || (at.Is("hybrid") && at.Region() != 0);
}

// Central differences of f(s), whose values carry the error `rounding`, with the steps h and 2 h,
// against the slope that is claimed up to `slack`. The two steps tell the truncation.
template <class F>
double AgainstDifferences(F f, const Matrix& claimed, const Quad& h, const Quad& rounding,
                          const Quad& slack) {
  const auto central = [&](const Quad& s) {
    Matrix slope = f(s) - f(-s);
    for (Quad& entry : slope.entries) entry /= 2 * s;
    return slope;
  };
  const Matrix one = central(h);
  const Quad error = FrobeniusNorm(one - claimed);
  if (error == 0) return 0;
  return static_cast<double>(error / (FrobeniusNorm(one - central(2 * h)) + rounding / h + slack));
}

// x + s d, each coordinate rounded to T.
template <class T>
std::vector<T> Moved(const Numbers& x, const Numbers& d, const Quad& s) {
  std::vector<T> moved;
  for (std::size_t i = 0; i < x.size(); ++i) moved.push_back(static_cast<T>(x[i] + s * d[i]));
  return moved;
}

// The bound on rounding, relative to the scale, in double and in float128.
Quad Rounding(const Case& at) { return kRatioBound * at.Energy().dofs * kUnit / at.Conditioning(); }
Quad QuadRounding(const Case& at) {
  return Rounding(at) / kUnit * (std::numeric_limits<Quad>::epsilon() / 2);
}

// Small against all that psi's derivatives change over.
double Step(const Case& at) {
  return std::cbrt(kUnit) * at.Conditioning() * static_cast<double>(NormOf(at.X()));
}
Quad QuadStep(const Case& at) { return Step(at) * 1e-6; }

Matrix Scalar(const Quad& value) { return Matrix(1, 1, value); }

std::optional<Finding> ValueDifferences(Case& at) {
  const Numbers d = WorstOfGradient(at);
  const double h = Step(at);
  if (!at.SameAround(d, 2 * h)) return std::nullopt;
  return Finding{AgainstDifferences(
      [&](const Quad& s) { return Scalar(at.ValueAt(Moved<double>(at.X(), d, s))); },
      Scalar(Dot(ToVector(at.Gradient()), ToVector(d))), h, Rounding(at) * ValueScale(at),
      Rounding(at) * GradientScale(at))};
}

std::optional<Finding> GradientDifferences(Case& at) {
  const Numbers d = WorstOfHessian(at);
  const double h = Step(at);
  if (HoldsClosestPoints(at) || !at.SameAround(d, 2 * h)) return std::nullopt;
  return Finding{AgainstDifferences(
      [&](const Quad& s) { return ToVector(at.GradientAt(Moved<double>(at.X(), d, s))); },
      at.Hessian() * ToVector(d), h, Rounding(at) * GradientScale(at),
      Rounding(at) * FrobeniusNorm(at.Truth().Hessian()))};
}

std::vector<Quad> Parameters(const Case& at) { return {at.P().begin(), at.P().end()}; }

std::optional<Finding> ReferenceGradient(Case& at) {
  const Numbers d = WorstOfGradient(at);
  if (!at.SameAround(d, 2 * Step(at))) return std::nullopt;
  const std::vector<Quad> p = Parameters(at);
  return Finding{AgainstDifferences(
      [&](const Quad& s) {
        return Scalar(at.Of().reference->value(Moved<Quad>(at.X(), d, s).data(), p.data()));
      },
      Scalar(Dot(at.Truth().Gradient(), ToVector(d))), QuadStep(at),
      QuadRounding(at) * ValueScale(at), QuadRounding(at) * GradientScale(at))};
}

std::optional<Finding> ReferenceHessian(Case& at) {
  const Numbers d = WorstOfHessian(at);
  if (HoldsClosestPoints(at) || !at.SameAround(d, 2 * Step(at))) return std::nullopt;
  const std::vector<Quad> p = Parameters(at);
  return Finding{AgainstDifferences(
      [&](const Quad& s) {
        return at.Of().reference->derivatives(Moved<Quad>(at.X(), d, s).data(), p.data()).gradient;
      },
      at.Truth().Hessian() * ToVector(d), QuadStep(at), QuadRounding(at) * GradientScale(at),
      QuadRounding(at) * FrobeniusNorm(at.Truth().Hessian()))};
}

}  // namespace

std::vector<Check> DerivativeChecks() {
  return {
      {"acts", "the kernel acts where the reference does, and is zero elsewhere", AppliesToAll,
       Activity, true},
      {"value", "the kernel's psi is the reference's", AppliesToAll, ValueError},
      {"gradient", "the kernel's gradient is psi's, by automatic differentiation in float128",
       AppliesToAll, GradientError},
      {"hessian", "the row none is psi's Hessian, by automatic differentiation in float128",
       AppliesToAll, HessianError},
      {"value_differences", "differences of the kernel's psi give its gradient where that is worst",
       AppliesToAll, ValueDifferences},
      {"gradient_differences",
       "differences of the kernel's gradient give its Hessian where that is worst", AppliesToAll,
       GradientDifferences},
      {"reference_gradient", "differences of the reference's psi in float128 give its gradient",
       AppliesToAll, ReferenceGradient},
      {"reference_hessian", "differences of the reference's gradient in float128 give its Hessian",
       AppliesToAll, ReferenceHessian},
  };
}

}  // namespace definite::verify
