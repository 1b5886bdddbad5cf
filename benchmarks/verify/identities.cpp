// Energies and filters that are the same where the theory says so. Each is looked at with every
// side of the pair and a stiffness of its own.

#include <cmath>

#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/verify/check.hpp"

namespace definite::verify {

namespace {

constexpr double kStiffness = 1.7;

double LengthOf(const std::string& energy, const Numbers& x, const Numbers& p) {
  return reference::FindEnergy<double>(energy)->length(x.data(), p.data());
}

// The energy's name with another length: the third of its parts.
std::string WithLength(std::string_view name, std::string_view length) {
  const std::size_t first = name.find('/', name.find('/') + 1) + 1;
  return std::string(name.substr(0, first)) + std::string(length) +
         std::string(name.substr(name.find('/', first)));
}

// An energy at a configuration.
struct Pair {
  Subject of;
  Numbers x, p;

  const std::string& Name() const { return of.energy->name; }
  Numbers Classified() const {
    Numbers where(3);
    of.energy->classify(x.data(), p.data(), where.data(), 1);
    return where;
  }
  bool Active() const { return Classified()[0] == 1; }
  bool Interior() const { return Classified()[2] == 0; }
  double Value() const {
    double value;
    of.energy->value(x.data(), p.data(), &value, 1);
    return value;
  }
  Numbers Gradient() const {
    Numbers gradient(x.size());
    of.energy->gradient(x.data(), p.data(), gradient.data(), 1);
    return gradient;
  }
  Numbers Filtered(std::string_view filter) const {
    const KernelRow& row = *of.Row(filter);
    Numbers out(static_cast<std::size_t>(row.outputs));
    RunOne(row, x.data(), p.data(), out.data());
    return out;
  }
  double Length() const { return LengthOf(Name(), x, p); }
  // Of the triple product, that is, of the signed length with side 0.
  int Sign() const {
    return LengthOf(WithLength(Name(), "signed"), x, {p[0], p[1], 0}) < 0 ? -1 : 1;
  }

  Pair With(std::size_t parameter, double value) const {
    Pair other = *this;
    other.p[parameter] = value;
    return other;
  }
  // Another length's energy with the same penalty, which may lack m or ex.
  Pair Of(std::string_view length, double side) const {
    const KernelRow* row = FindKernel(WithLength(Name(), length) + "/none/f64");
    Pair other = {{row->energy, {}, nullptr}, x, p};
    if (other.of.energy->parameters.size() < p.size()) other.p.erase(other.p.begin() + 3);
    other.p[2] = side;
    return other;
  }
};

// The error in units of its bound, relative to the scale.
double Error(const Case& at, double error, double scale) {
  return error == 0 ? 0 : at.Ratio(error, scale);
}

double SameMatrix(const Case& at, const Pair& one, const Pair& other, std::string_view filter) {
  const Numbers f = one.Filtered(filter), g = other.Filtered(filter);
  return Error(at, FrobeniusDistance(f, g), FrobeniusNorm(f));
}

double Largest(std::initializer_list<double> errors) {
  double worst = 0;
  for (const double error : errors) worst = std::isnan(error) ? kInfinite : std::max(worst, error);
  return worst;
}

double SameGradient(const Case& at, const Pair& one, const Pair& other) {
  const Numbers g = one.Gradient(), h = other.Gradient();
  double distance = 0, norm = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    distance = std::hypot(distance, g[i] - h[i]);
    norm = std::hypot(norm, g[i]);
  }
  return Error(at, distance, norm);
}

// Value, gradient and Hessian.
double SameEnergy(const Case& at, const Pair& one, const Pair& other) {
  if (!other.Active()) return kInfinite;
  const double value = one.Value();
  return Largest({Error(at, std::abs(value - other.Value()), std::abs(value)),
                  SameGradient(at, one, other), SameMatrix(at, one, other, "none")});
}

// The worst that compare(at, pair) finds with the sides 0, 1 and -1, where the pair then acts.
template <class Compare>
std::optional<Finding> OverSides(Case& at, Compare compare) {
  std::optional<Finding> worst;
  for (const double side : {0.0, 1.0, -1.0}) {
    Pair pair = {at.Of(), at.X(), at.P()};
    pair.p[0] = kStiffness;
    pair.p[2] = side;
    if (!pair.Active()) continue;
    if (const std::optional<double> violation = compare(at, pair)) {
      worst = Worse(worst, Finding{*violation});
    }
  }
  return worst;
}

template <std::optional<double> (*kCompare)(const Case&, const Pair&)>
std::optional<Finding> OverAllSides(Case& at) {
  return OverSides(at, kCompare);
}

// The side of a signed length that makes it as negative as that of an unsigned pair.
double SignedSide(const Pair& pair) { return (pair.Length() < 0 ? -1 : 1) * pair.Sign(); }

std::optional<double> UnsignedIsSigned(const Case& at, const Pair& pair) {
  if (!pair.Interior()) return std::nullopt;
  return SameEnergy(at, pair, pair.Of("signed", SignedSide(pair)));
}

// An energy whose filter in the frame is the signed one's too.
double SameFilters(const Case& at, const Pair& pair, const Pair& other) {
  return Largest({SameEnergy(at, pair, other), SameMatrix(at, pair, other, "analytic"),
                  SameMatrix(at, pair, other, "absolute")});
}

std::optional<double> HybridIsSignedInside(const Case& at, const Pair& pair) {
  if (!pair.Interior()) return std::nullopt;
  return SameFilters(at, pair, pair.Of("signed", pair.p[2]));
}

// An unsigned length has the sign of the hybrid's where it is given that sign.
Pair Frozen(const Pair& hybrid) {
  return hybrid.Of("unsigned_frozen", hybrid.p[2] < 0 ? -hybrid.Sign() : hybrid.Sign());
}

std::optional<double> HybridIsFrozenAtEnds(const Case& at, const Pair& pair) {
  if (pair.Interior()) return std::nullopt;
  return Largest(
      {SameEnergy(at, pair, Frozen(pair)), SameMatrix(at, pair, Frozen(pair), "analytic")});
}

std::optional<double> HybridHasTheCurvatureOfFrozen(const Case& at, const Pair& pair) {
  return SameMatrix(at, pair, Frozen(pair), "gauss_newton");
}

// Bit for bit outside contact, and not at all inside.
std::optional<double> FrozenIsGaussNewtonOutside(const Case&, const Pair& pair) {
  const bool same = pair.Filtered("analytic") == pair.Filtered("gauss_newton");
  return same == (pair.Length() > 0) ? 0 : kInfinite;
}

// At an end the sign of the length is free, and psi jumps with it by 4 k eps u.
std::optional<double> EnergyJumps(const Case& at, const Pair& pair) {
  const Pair other = pair.With(2, pair.p[2] < 0 ? 1 : -1);
  if (pair.Interior() || !other.Active()) return std::nullopt;
  const double one = pair.Value(), two = other.Value();
  return Error(at,
               std::abs(std::abs(one - two) - 4 * pair.p[0] * pair.p[1] * std::abs(pair.Length())),
               std::max(one, two));
}

constexpr std::size_t kM = 3;  // the parameter m of the mixed length

std::optional<double> WholeMIsSigned(const Case& at, const Pair& pair) {
  const Pair whole = pair.With(kM, 1);
  if (!whole.Active()) return std::nullopt;
  return SameFilters(at, whole, whole.Of("signed", pair.p[2]));
}

std::optional<double> MDropsOutOutside(const Case& at, const Pair& pair) {
  if (!(pair.Length() > 0)) return std::nullopt;
  return Largest(
      {SameEnergy(at, pair, pair.With(kM, 0.5)), SameEnergy(at, pair, pair.With(kM, 1))});
}

std::optional<double> HalfMHasNoForceInside(const Case&, const Pair& pair) {
  if (!(pair.Length() < 0)) return std::nullopt;
  const Pair half = pair.With(kM, 0.5);
  return half.Active() && AllZero(half.Gradient()) ? 0 : kInfinite;
}

constexpr std::size_t kThreshold = 3;  // the parameter ex of the mollifier

// A gradient of the mollifier that is not quite 0 would show in every filter.
std::optional<double> MollifiedIsUnsignedAbove(const Case& at, const Pair& pair) {
  const Pair above = pair.With(kThreshold, 1e-60);
  if (!above.Active()) return std::nullopt;
  const Pair other = above.Of("unsigned", pair.p[2]);
  return Largest({SameFilters(at, above, other), SameMatrix(at, above, other, "nearest")});
}

// A row through the frame rounds in units of all that it adds up, which is what absolute values
// add up to.
std::optional<Finding> Namesakes(Case& at) {
  std::optional<Finding> worst;
  const double scale = FrobeniusNorm(at.Output(*at.Of().Row("absolute")));
  for (const auto& [through_frame, filter] : {std::pair("numeric_frame", "analytic"),
                                              {"analytic_frame", "analytic"},
                                              {"gauss_newton_frame", "gauss_newton"}}) {
    const KernelRow* row = at.Of().Row(through_frame);
    if (!row) continue;
    const double distance = FrobeniusDistance(at.Output(*row), at.Output(*at.Of().Row(filter)));
    worst = Worse(worst, Finding{Error(at, distance, scale), row});
  }
  return worst;
}

bool Has(const Subject& subject, std::string_view part) {
  return HasPart(subject.energy->name, part);
}
// Of the registry: it may have been built without.
bool ThereIs(const Subject& subject, std::string_view length) {
  return FindKernel(WithLength(subject.energy->name, length) + "/none/f64") != nullptr;
}
bool IsUnsigned(const Subject& subject) {
  return (Has(subject, "vertex_face") || Has(subject, "edge_edge")) && Has(subject, "unsigned") &&
         ThereIs(subject, "signed");
}
bool IsHybrid(const Subject& subject) { return Has(subject, "hybrid"); }
bool IsHybridBesideSigned(const Subject& subject) {
  return IsHybrid(subject) && ThereIs(subject, "signed");
}
bool IsHybridBesideFrozen(const Subject& subject) {
  return IsHybrid(subject) && ThereIs(subject, "unsigned_frozen");
}
bool IsQuadraticHybrid(const Subject& subject) {
  return IsHybrid(subject) && Has(subject, "quadratic");
}
bool IsFrozen(const Subject& subject) { return Has(subject, "unsigned_frozen"); }
bool IsAnisotropic(const Subject& subject) { return Has(subject, "anisotropic"); }
bool IsAnisotropicBesideSigned(const Subject& subject) {
  return IsAnisotropic(subject) && ThereIs(subject, "signed");
}
bool IsMollifiedBesideUnsigned(const Subject& subject) {
  return Has(subject, "mollified") && ThereIs(subject, "unsigned");
}
bool HasFrameRows(const Subject& subject) {
  return subject.Row("numeric_frame") && subject.Row("analytic") && subject.Row("absolute");
}

}  // namespace

std::vector<Check> IdentityChecks() {
  return {
      {"unsigned_is_signed",
       "psi, gradient, Hessian are the signed length's at interior closest points", IsUnsigned,
       OverAllSides<UnsignedIsSigned>},
      {"hybrid_is_signed", "likewise for the hybrid, with its analytic and absolute filters",
       IsHybridBesideSigned, OverAllSides<HybridIsSignedInside>},
      {"hybrid_is_frozen", "at an end the hybrid is the frozen length", IsHybridBesideFrozen,
       OverAllSides<HybridIsFrozenAtEnds>},
      {"hybrid_curvature", "Gauss-Newton of the hybrid is that of the frozen length everywhere",
       IsHybridBesideFrozen, OverAllSides<HybridHasTheCurvatureOfFrozen>},
      {"hybrid_jump", "at an end psi jumps by 4 k eps u with the sign of the length",
       IsQuadraticHybrid, OverAllSides<EnergyJumps>},
      {"frozen_gauss_newton",
       "the analytic filter is Gauss-Newton, bit for bit, outside contact alone", IsFrozen,
       OverAllSides<FrozenIsGaussNewtonOutside>},
      {"m_1_is_signed", "m = 1 is the signed length, with its analytic and absolute filters",
       IsAnisotropicBesideSigned, OverAllSides<WholeMIsSigned>},
      {"m_drops_out", "psi, gradient and Hessian do not depend on m where l > 0", IsAnisotropic,
       OverAllSides<MDropsOutOutside>},
      {"m_half_no_force", "m = 1/2 leaves no force where l < 0", IsAnisotropic,
       OverAllSides<HalfMHasNoForceInside>},
      {"mollified_is_unsigned", "above its threshold, with three filters",
       IsMollifiedBesideUnsigned, OverAllSides<MollifiedIsUnsignedAbove>},
      {"frame_rows", "filters through the frame's products are their namesakes in x", HasFrameRows,
       Namesakes},
  };
}

}  // namespace definite::verify
