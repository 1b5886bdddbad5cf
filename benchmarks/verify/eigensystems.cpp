// Mode sets that claim to be eigensystems: each mode is an eigenpair, they are orthogonal, and
// together they are the whole matrix.

#include <algorithm>

#include "benchmarks/verify/check.hpp"
#include "benchmarks/verify/modes.hpp"

namespace definite::verify {

namespace {

struct EigenErrors {
  Quad residual = 0;       // the worst |A v - lambda v| / scale
  Quad orthogonality = 0;  // the worst |v_i . v_j|
  Quad completeness = 0;   // |A - sum lambda v v^T| / scale
};

// The scale is that of the whole Hessian: A may be psi' times something, and psi' near 0 has the
// rounding of l.
EigenErrors ErrorsOf(const std::vector<Mode>& modes, const Matrix& a, const Quad& scale) {
  EigenErrors errors;
  Matrix rest = a;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const auto& [lambda, v] = modes[i];
    Matrix residual = a * v;
    for (int k = 0; k < v.rows; ++k) residual[k] -= lambda * v[k];
    errors.residual = std::max(errors.residual, FrobeniusNorm(residual));
    for (std::size_t j = 0; j < i; ++j) {
      errors.orthogonality = std::max(errors.orthogonality, Quad(abs(Dot(v, modes[j].v))));
    }
    rest = rest - Outer(lambda, v);
  }
  errors.completeness = FrobeniusNorm(rest);
  for (Quad* error : {&errors.residual, &errors.completeness}) {
    if (*error != 0) *error /= scale;
  }
  return errors;
}

// The reference's terms, those of one map added up until there are as many as the kernel's.
std::vector<reference::FrameTerm<Quad>> TermsLikeTheKernels(Case& at) {
  std::vector<reference::FrameTerm<Quad>> terms = at.Truth().FrameTerms();
  while (terms.size() > at.Energy().frame.size()) {
    terms[0].hessian = terms[0].hessian + terms[1].hessian;
    terms.erase(terms.begin() + 1);
  }
  return terms;
}

// Whether c of kernel and reference point the same way. At the end of edge A the reference looks
// back from B.
bool SameFrame(Case& at, const Matrix& map) {
  const Matrix ours = MapOf(at, at.Energy().frame.front());
  Quad difference = 0, size = 0;
  for (int i = map.rows - 3; i < map.rows; ++i) {
    for (int j = 0; j < map.cols; ++j) {
      difference += abs(ours(i, j) - map(i, j));
      size += abs(map(i, j));
    }
  }
  return difference <= Quad(1e-3) * size;
}

template <Quad EigenErrors::*kError>
std::optional<Finding> OfFrame(Case& at) {
  const auto terms = TermsLikeTheKernels(at);
  if (!SameFrame(at, terms.front().map)) return std::nullopt;
  Quad scale = 0;
  for (const auto& term : terms) scale += FrobeniusNorm(term.hessian);
  std::optional<Finding> worst;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const EigenErrors errors =
        ErrorsOf(ModesOf(at, at.Energy().frame[t].modes), terms[t].hessian, scale);
    worst = Worse(worst, Finding{at.Ratio(errors.*kError, 1, terms[t].hessian.rows)});
  }
  return worst;
}

// The geometric term alone: the curvature is the first mode, and not orthogonal to the others.
template <Quad EigenErrors::*kError>
std::optional<Finding> OfSplit(Case& at) {
  const std::vector<Mode> modes = ModesOf(at, at.Energy().split, 1);
  const EigenErrors errors = ErrorsOf(modes, at.Truth().Hessian() - at.Truth().Curvature(),
                                      FrobeniusNorm(at.Truth().Hessian()));
  return Finding{at.Ratio(errors.*kError, 1)};
}

bool HasSplit(const Subject& subject) { return subject.energy->split.count > 0; }

}  // namespace

std::vector<Check> EigensystemChecks() {
  return {
      {"frame_eigenpairs", "frame modes are eigenpairs of Hess_c psi (Eqs. 11-13, 35, 51, 52)",
       HasFrame, OfFrame<&EigenErrors::residual>},
      {"frame_orthogonal", "frame modes are orthogonal in c", HasFrame,
       OfFrame<&EigenErrors::orthogonality>},
      {"frame_complete", "frame modes are all of Hess_c psi: the rest of c is its null space",
       HasFrame, OfFrame<&EigenErrors::completeness>},
      {"split_eigenpairs", "split modes are eigenpairs of psi' Hess l in x", HasSplit,
       OfSplit<&EigenErrors::residual>},
      {"split_orthogonal", "split modes are orthogonal in x", HasSplit,
       OfSplit<&EigenErrors::orthogonality>},
      {"split_complete", "split modes are all of psi' Hess l in x", HasSplit,
       OfSplit<&EigenErrors::completeness>},
  };
}

}  // namespace definite::verify
