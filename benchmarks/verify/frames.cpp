// The change of basis from the reduced frame to x (Eqs. 15-20 and appendix B), and the inertia of
// the Hessian.

#include <algorithm>
#include <limits>

#include "benchmarks/verify/check.hpp"
#include "benchmarks/verify/modes.hpp"
#include "reference/stencils.hpp"

namespace definite::verify {

namespace {

// An error against what rounding in float128 does to a number of that size. The weights of the
// frame are quotients that cancel, the printed ones like 1/sin^2; the direction of c2 turns by
// |x|/|l|.
double QuadRatio(const Case& at, const Quad& error, const Quad& scale) {
  const Quad part = std::numeric_limits<Quad>::epsilon() / 2 / kUnit;
  const Quad nearness =
      std::min(Quad(1), Quad(abs(Quad(at.Length())) / FrobeniusNorm(ToVector(at.X()))));
  return at.Ratio(error * at.Conditioning() * nearness, scale * part);
}

// The kernel's terms, pulled back by its own maps, against its Hessian; in units of what they add
// up.
std::optional<Finding> KernelTerms(Case& at) {
  Matrix rest = at.Hessian();
  Quad scale = 0;
  for (const FrameTable& term : at.Energy().frame) {
    const Matrix pull_back = Transpose(MapOf(at, term));
    for (const auto& [lambda, v] : ModesOf(at, term.modes)) {
      const Matrix mode = Outer(lambda, pull_back * v);
      rest = rest - mode;
      scale += FrobeniusNorm(mode);
    }
  }
  return Finding{at.Ratio(FrobeniusNorm(rest), scale)};
}

// The same of the reference, in float128.
std::optional<Finding> ReferenceTerms(Case& at) {
  Matrix rest = at.Truth().Hessian();
  Quad scale = FrobeniusNorm(rest);
  for (const reference::FrameTerm<Quad>& term : at.Truth().FrameTerms()) {
    const Matrix part = Congruence(term.hessian, term.map);
    rest = rest - part;
    scale += FrobeniusNorm(part);
  }
  return Finding{QuadRatio(at, FrobeniusNorm(rest), scale)};
}

// The parts of the chain rule with c(x), the frame whose weights follow x, J = S + D:
//   Hess_x = J^T Hc J + sum_k gc_k Hess_x c_k = S^T Hc S + A1 + A2,  A1 = D^T Hc D.
struct ChainRule {
  Matrix simplified, a1, a2;
  Quad scale;  // of all that is added up

  // `length` of the nine frame numbers is what psi is a penalty of.
  template <class Stencil, class Length>
  static ChainRule Of(Case& at, Stencil, Length length) {
    const std::vector<Quad> x(at.X().begin(), at.X().end());
    const auto variables = reference::Variables<12>(x.data());
    const auto frozen = reference::FrozenFrame<Stencil>(variables.data(), x.data());
    const auto free = reference::FrozenFrame<Stencil>(variables.data(), variables.data());
    const Matrix s = reference::Jacobian(frozen), d = reference::Jacobian(free) - s;
    const auto values = reference::Values<9>(free.data());
    const auto l = Unpack(length(reference::Variables<9>(values.data())));

    // psi' and psi'' from what they make of grad l.
    const Matrix gradient = Transpose(s) * l.gradient;
    const Quad square = Dot(gradient, gradient);
    const Quad psi1 = Dot(at.Truth().Gradient(), gradient) / square;
    const Quad psi2 = Dot(gradient, at.Truth().Curvature() * gradient) / (square * square);
    Matrix h = Outer(psi2, l.gradient);
    for (std::size_t k = 0; k < h.entries.size(); ++k) {
      h.entries[k] += psi1 * l.hessian.entries[k];
    }

    ChainRule rule;
    rule.simplified = Congruence(h, s);
    rule.a1 = Congruence(h, d);
    const Matrix mixed = Transpose(d) * h * s;
    rule.a2 = mixed + Transpose(mixed);
    rule.scale = FrobeniusNorm(rule.simplified) + FrobeniusNorm(rule.a1) + FrobeniusNorm(mixed);
    for (int k = 0; k < 9; ++k) {
      Matrix part = Unpack(free.data()[k]).hessian;
      for (Quad& entry : part.entries) entry *= psi1 * l.gradient[k];
      rule.a2 = rule.a2 + part;
      rule.scale += FrobeniusNorm(part);
    }
    return rule;
  }

  static ChainRule Of(Case& at) {
    const auto signed_length = [&](const auto& c) {
      return reference::OnSide(reference::AlongNormal(reference::FrameEdges(c.data())), at.P()[2]);
    };
    const double sign = at.Length();
    const auto unsigned_length = [&](const auto& c) {
      return reference::OnSide(Norm(reference::FrameEdges(c.data()).e2), sign);
    };
    if (at.Is("vertex_face")) {
      return at.Is("signed") ? Of(at, reference::VertexFace(), signed_length)
                             : Of(at, reference::VertexFace(), unsigned_length);
    }
    return at.Is("signed") ? Of(at, reference::EdgeEdge(), signed_length)
                           : Of(at, reference::EdgeEdge(), unsigned_length);
  }
};

// Signed or unsigned lengths in the paper's frame.
bool IsPaperLength(const Subject& subject) {
  const std::string& name = subject.energy->name;
  return (HasPart(name, "vertex_face") || HasPart(name, "edge_edge")) &&
         (HasPart(name, "signed") || HasPart(name, "unsigned"));
}
bool IsInterior(const Case& at) { return at.Region() == 0; }

std::optional<Finding> ChainRuleSum(Case& at) {
  if (!IsInterior(at)) return std::nullopt;
  const ChainRule rule = ChainRule::Of(at);
  const Matrix rest = at.Truth().Hessian() - rule.simplified - rule.a1 - rule.a2;
  return Finding{QuadRatio(at, FrobeniusNorm(rest), rule.scale)};
}

std::optional<Finding> CorrectiveTerms(Case& at) {
  if (!IsInterior(at)) return std::nullopt;
  const ChainRule rule = ChainRule::Of(at);
  const Matrix of_hessian = at.Truth().Hessian() - rule.simplified;
  return Worse(Finding{QuadRatio(at, FrobeniusNorm(rule.a1 + rule.a2 + rule.a1), rule.scale)},
               Finding{QuadRatio(at, FrobeniusNorm(of_hessian + rule.a1), rule.scale)});
}

// Zero for signed lengths; for unsigned ones at least a billionth of the Hessian.
std::optional<Finding> FirstCorrectiveTerm(Case& at) {
  if (!IsInterior(at)) return std::nullopt;
  const ChainRule rule = ChainRule::Of(at);
  const Quad a1 = FrobeniusNorm(rule.a1);
  if (at.Is("signed")) return Finding{QuadRatio(at, a1, rule.scale)};
  return Finding{static_cast<double>(FrobeniusNorm(at.Truth().Hessian()) * 1e-9 / a1)};
}

// How many eigenvalues of the Hessian are positive and negative where psi'' > 0 and psi' != 0.
struct Inertia {
  int positive, negative;
};

std::optional<Inertia> InertiaOf(const Case& at) {
  constexpr Inertia kBothFree = {3, 2}, kOutside = {1, 2}, kInside = {3, 0};
  const bool outside = at.Length() > 0;
  const Inertia both_fixed = outside ? kOutside : kInside;
  const Inertia one_free = outside ? Inertia{2, 2} : Inertia{3, 1};
  if (at.Is("vertex_vertex") || at.Is("unsigned_frozen")) return both_fixed;
  if (at.Is("vertex_edge")) return one_free;
  if (at.Is("hybrid")) return at.Region() == 0 ? kBothFree : both_fixed;
  if (at.Is("edge_edge") && at.Is("unsigned")) {
    return at.Region() == 0 ? kBothFree : at.Region() == 1 ? one_free : both_fixed;
  }
  if (at.Is("signed") || at.Is("unsigned") || at.Is("anisotropic")) return kBothFree;
  return std::nullopt;
}

// The eigenvalues that are not zero stand out by a factor of 1000 at least, and have these signs.
std::optional<Finding> InertiaError(Case& at) {
  const std::optional<Inertia> inertia = InertiaOf(at);
  if (!inertia) return std::nullopt;
  std::vector<Quad> values = at.Truth().HessianSpectrum().values.entries;
  std::ranges::sort(values, [](const Quad& a, const Quad& b) { return abs(a) > abs(b); });
  const auto rank = inertia->positive + inertia->negative;
  const auto positive =
      std::count_if(values.begin(), values.begin() + rank, [](const Quad& v) { return v > 0; });
  if (positive != inertia->positive) return Finding{kInfinite};
  const auto last = static_cast<std::size_t>(rank);
  return Finding{
      last == values.size() ? 0 : static_cast<double>(1000 * abs(values[last] / values[last - 1]))};
}

bool HasReferenceFrame(const Subject& subject) { return subject.reference->frame != nullptr; }
bool IsCollision(const Subject& subject) {
  return HasPart(subject.energy->name, "collision") && !HasPart(subject.energy->name, "mollified");
}

}  // namespace

std::vector<Check> FrameChecks() {
  return {
      {"frame_terms", "the kernel's frame terms, pulled back, add up to its Hessian (Eq. 17)",
       HasFrame, KernelTerms},
      {"reference_terms", "the same of the reference, in float128 (Eq. 17)", HasReferenceFrame,
       ReferenceTerms},
      {"chain_rule", "S^T Hess_c S + A1 + A2 is the Hessian, in float128 (Eq. 59)", IsPaperLength,
       ChainRuleSum},
      {"corrective_terms", "A1 + A2 = -A1, in float128, and the Hessian is S^T Hess_c S - A1",
       IsPaperLength, CorrectiveTerms},
      {"first_corrective_term", "A1 is zero for signed lengths, and is not for unsigned ones",
       IsPaperLength, FirstCorrectiveTerm},
      {"inertia", "the Hessian has as many positive and negative eigenvalues as theory says",
       IsCollision, InertiaError},
  };
}

}  // namespace definite::verify
