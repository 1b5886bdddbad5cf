#include "benchmarks/plans/shi_kim_2023_errata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/plans/markdown.hpp"
#include "reference/oracle.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite {

namespace {

using reference::EdgeEdge;
using reference::Edges;
using reference::Quad;
using reference::VertexFace;
using Matrix = reference::Matrix<Quad>;
template <int N>
using Dual = reference::Dual2<Quad, N>;

const Quad kK = 1, kEps = 1, kM = Quad(8) / 10;

std::array<Quad, 12> InQuad(const double* x) {
  std::array<Quad, 12> q;
  std::copy_n(x, 12, q.begin());
  return q;
}

// Calls f with the stencil's type.
template <class F>
auto WithStencil(std::string_view stencil, F f) {
  return stencil == "vertex_face" ? f(VertexFace()) : f(EdgeEdge());
}

// The reduced frame of a pair (Eq. 2), its nine numbers as the variables.
Edges<Dual<9>> FrameOf(std::string_view stencil, const double* x) {
  const std::array<Quad, 12> q = InQuad(x);
  const auto c = WithStencil(stencil, [&]<class Stencil>(Stencil) {
    return reference::FrozenFrame<Stencil>(q.data(), q.data());
  });
  const auto variables = reference::Variables<9>(c.data());
  return reference::FrameEdges(variables.data());
}

reference::Vec3<Quad> ValueOf(const reference::Vec3<Dual<9>>& v) {
  return {v.x.value, v.y.value, v.z.value};
}

// Writes s v into slot i of a stacked vector.
void Put(Matrix& stacked, int i, const Quad& s, const reference::Vec3<Quad>& v) {
  stacked[3 * i] = s * v.x;
  stacked[3 * i + 1] = s * v.y;
  stacked[3 * i + 2] = s * v.z;
}

Matrix Scaled(const Quad& s, Matrix m) {
  for (Quad& entry : m.entries) entry *= s;
  return m;
}

double RelativeError(const Matrix& a, const Matrix& exact) {
  return static_cast<double>(FrobeniusNorm(a - exact) / FrobeniusNorm(exact));
}

// The display after Eq. 10, through the gradient of l in x that it gives by Eq. 16.
std::optional<double> LengthGradientError(Form form, std::string_view stencil, const double* x) {
  const std::array<Quad, 12> q = InQuad(x);
  const auto variables = reference::Variables<12>(q.data());
  return WithStencil(stencil, [&]<class Stencil>(Stencil) {
    const auto l = reference::AlongNormal(Stencil::EdgesOf(variables.data()));
    const auto c = reference::FrozenFrame<Stencil>(variables.data(), q.data());
    const reference::Vec3<Quad> e2_perp = {c[6].value, c[7].value, c[8].value};
    Matrix g(9, 1);
    // Erratum: printed (0_3; (l/|e2perp|) e2perp-hat), with one block of zeros.
    Put(g, form == Form::kPrinted ? 1 : 2, l.value / Dot(e2_perp, e2_perp), e2_perp);
    return std::optional(RelativeError(Transpose(reference::Jacobian(c)) * g, Unpack(l).gradient));
  });
}

// Eq. 25 outside contact: how hard the pair attracts, in units of the force at u = 0.
std::optional<double> AttractionError(Form form, std::string_view, const double* x) {
  static const auto& of_lines =
      *reference::FindEnergy<Quad>("collision/edge_edge/signed/quadratic");
  static const auto& of_edges =
      *reference::FindEnergy<Quad>("collision/edge_edge/unsigned/quadratic");
  const std::array<Quad, 12> q = InQuad(x);
  const Quad outside[] = {kK, kEps, 1};
  const Quad l = of_lines.length(q.data(), outside), u = of_edges.length(q.data(), outside);
  if (l < 0 || l >= kEps) return std::nullopt;
  const bool acts = form == Form::kPrinted ? l < kEps : u < kEps;  // Erratum: printed l < eps
  const Quad slope = acts ? Quad(2 * kK * (u - kEps)) : Quad(0);
  return std::max(0.0, static_cast<double>(slope / (2 * kK * kEps)));
}

// Eq. 31 (slot 1, the edge e1perp) or 32 (slot 0, e0perp): |H q - lambda q| / |H q|, the worse of
// both signs, q of Eqs. 10-12.
template <int kSlot>
std::optional<double> BarrierError(Form form, std::string_view stencil, const double* x) {
  const Edges<Dual<9>> c = FrameOf(stencil, x);
  const Dual<9> length = reference::AlongNormal(c);
  const Quad l = length.value;
  if (!(l > 0 && l < kEps)) return std::nullopt;
  const Quad p[] = {kK, kEps};
  const Matrix h = Unpack(reference::LogBarrier::Value(length, p, p + 2)).hessian;
  const auto edge = ValueOf(kSlot == 0 ? c.e0 : c.e1), e2 = ValueOf(c.e2);
  const Quad len2 = Dot(edge, edge), e22 = Dot(e2, e2);
  const Quad f = sqrt(1 + 4 * len2 / e22);
  // Erratum: printed without the factor l at the logarithm.
  const Quad factor = form == Form::kPrinted ? Quad(1) : l;
  double worst = 0;
  for (const int sign : {1, -1}) {
    const Quad of_l = -l / (2 * len2) * (1 + sign * f);
    const Quad omega = of_l / (of_l - l / e22);
    const Quad lambda =
        (kEps - l) * (kEps - l - 2 * factor * log(l / kEps)) / (2 * len2) * (1 + sign * f);
    Matrix eigenvector(9, 1);
    Put(eigenvector, kSlot, 1, e2);
    Put(eigenvector, 2, omega, edge);
    worst = std::max(worst, RelativeError(Scaled(lambda, eigenvector), h * eigenvector));
  }
  return worst;
}

// Eq. 35 for psi = k (h - eps)^2: |printed - Hess_c psi| / |Hess_c psi|.
std::optional<double> MixedError(Form form, std::string_view stencil, const double* x) {
  const Edges<Dual<9>> c = FrameOf(stencil, x);
  const Dual<9> l = reference::AlongNormal(c), u = Norm(c.e2);
  const Dual<9> h = kM * l + (1 - kM) * u;
  if (h >= kEps) return std::nullopt;
  const Matrix exact = Unpack(kK * (h - kEps) * (h - kEps)).hessian;
  const auto of_l = Unpack(l), of_u = Unpack(u);
  const Quad d = h.value - kEps;
  const Quad psi_ll = 2 * kK * kM * kM, psi_uu = 2 * kK * (1 - kM) * (1 - kM),
             psi_lu = 2 * kK * kM * (1 - kM);
  // Erratum: printed without sgn(l), though g_u = sgn(l) g_l.
  const Quad sign = form == Form::kCorrected && l.value < 0 ? -1 : 1;
  return RelativeError(Outer(Quad(psi_ll + psi_uu + 2 * sign * psi_lu), of_l.gradient) +
                           Scaled(2 * kK * kM * d, of_l.hessian) +
                           Scaled(2 * kK * (1 - kM) * d, of_u.hessian),
                       exact);
}

constexpr std::string_view kBoth[] = {"vertex_face", "edge_edge"}, kEdges[] = {"edge_edge"};

constexpr std::string_view kEigenpair = "|H q - lambda q| / |H q|, the worse of both signs";
constexpr std::string_view kLacksL =
    "psi' = (eps - l) (-(eps - l) / l + 2 ln(l/eps)) times -l of Eqs. 11 and 12 leaves a factor l "
    "at the logarithm. Without it the eigenvalue has no unit: the error depends on the unit of "
    "length. Its sign is right, so a filter that only looks at signs keeps the right modes.";

constexpr Misprint kMisprints[] = {
    {"g_l after Eq. 10", "g_l = (0_3; (l/|e2perp|) e2perp-hat)",
     "g_l = (0_3; 0_3; (l/|e2perp|) e2perp-hat)", "|S^T g_l - grad l| / |grad l|",
     "Six entries where c has nine; Eq. 57 has them all. Measured with the second block of zeros "
     "at the end.",
     kBoth, LengthGradientError},
    {"Eq. 25", "psi_uq(u) = k (u -+ eps)^2 where l < eps, else 0",
     "psi_uq(u) = k (u - eps)^2 where u < eps, else 0; inside contact k (u + eps)^2",
     "psi' / (2 k eps) where it is positive: attraction, in units of the force at u = 0",
     "The distance l of the two lines may be below eps while the distance u of the edges, whose "
     "closest points are clamped, is not. Harmless where u = |l|. Measured outside contact, over "
     "the pairs that the printed test calls active.",
     kEdges, AttractionError},
    {"Eq. 31", "lambda_0,1 = (eps - l) (eps - l - 2 ln(l/eps)) / (2 |e1perp|^2) (1 +- f(1, 2))",
     "lambda_0,1 = (eps - l) (eps - l - 2 l ln(l/eps)) / (2 |e1perp|^2) (1 +- f(1, 2))", kEigenpair,
     kLacksL, kBoth, BarrierError<1>},
    {"Eq. 32", "lambda_2,3 = (eps - l) (eps - l - 2 ln(l/eps)) / (2 |e0perp|^2) (1 +- f(0, 2))",
     "lambda_2,3 = (eps - l) (eps - l - 2 l ln(l/eps)) / (2 |e0perp|^2) (1 +- f(0, 2))", kEigenpair,
     "As Eq. 31.", kBoth, BarrierError<0>},
    {"Eq. 35", "(psi_ll + psi_uu + 2 psi_lu) g_l g_l^T + psi_l H_l + psi_u H_u",
     "(psi_ll + psi_uu + 2 sgn(l) psi_lu) g_l g_l^T + psi_l H_l + psi_u H_u",
     "|printed - Hess_c psi| / |Hess_c psi|, Frobenius norms",
     "g_u = sgn(l) g_l, so the cross term changes its sign with l: the two forms agree for l > 0.",
     kBoth, MixedError},
};

constexpr double kRounding = 1e-20;  // what exceeds it is no rounding of float128

// 3.2e-33 as "below 1e-32": the same for every version of libquadmath.
std::string Below(double error) {
  if (error == 0) return "0";
  return fmt::format("below 1e{:.0f}", std::floor(std::log10(error)) + 1);
}

}  // namespace

std::span<const Misprint> ShiKim2023Errata::All() { return kMisprints; }

const Misprint& ShiKim2023Errata::Of(std::string_view equation) {
  const auto at = std::ranges::find(kMisprints, equation, &Misprint::equation);
  if (at == std::end(kMisprints)) throw std::logic_error("no such misprint");
  return *at;
}

MisprintSize Measure(const Misprint& misprint) {
  const Distribution& distribution = *FindDistribution(ShiKim2023Errata::kDistribution);
  MisprintSize size;
  std::vector<double> errors;
  for (const std::string_view stencil : misprint.stencils) {
    for (int i = 0; i < ShiKim2023Errata::kPairs; ++i) {
      double x[12];
      distribution.draw({stencil, 12, {}}, ShiKim2023Errata::kSeed, static_cast<std::uint64_t>(i),
                        x, nullptr);
      const auto printed = misprint.error(Form::kPrinted, stencil, x);
      if (!printed) continue;
      ++size.pairs;
      if (!(*printed <= kRounding)) errors.push_back(*printed);
      size.corrected =
          std::max(size.corrected, misprint.error(Form::kCorrected, stencil, x).value());
    }
  }
  std::ranges::sort(errors);
  size.wrong = errors.size();
  if (!errors.empty()) {
    size.median = errors[(errors.size() - 1) / 2];
    size.largest = errors.back();
  }
  return size;
}

std::string ShiKim2023Errata::Markdown() {
  std::vector<std::vector<std::string>> table = {
      {"", "pairs", "wrong in", "median error", "largest", "corrected"}};
  std::string sections;
  for (const Misprint& misprint : kMisprints) {
    const MisprintSize size = Measure(misprint);
    table.push_back({std::string(misprint.equation), std::to_string(size.pairs),
                     fmt::format("{:.0f} %", 100.0 * static_cast<double>(size.wrong) /
                                                 static_cast<double>(size.pairs)),
                     fmt::format("{:.2g}", size.median), fmt::format("{:.2g}", size.largest),
                     Below(size.corrected)});
    sections += fmt::format("\n## {}\n\n    printed    {}\n    holds      {}\n\n",
                            misprint.equation, misprint.printed, misprint.corrected);
    sections += Wrapped(fmt::format("Error: {}. {}", misprint.figure, misprint.remark), 98, "");
  }
  return "# Errata of Shi & Kim 2023\n\n" +
         Wrapped(fmt::format(
                     "What \"A Unified Analysis of Penalty-Based Collision Energies\" prints and "
                     "does not hold, measured in float128 by `definite verify --errata`: {} pairs "
                     "of `{}` for each of vertex-face and edge-edge, seed {}, k = 1, eps = 1, m = "
                     "0.8, less those that an equation says nothing of. Median and largest error "
                     "are over the pairs where the printed form is wrong; the last column is the "
                     "largest error of the corrected one.",
                     kPairs, kDistribution, kSeed),
                 98, "") +
         "\n" + MarkdownTable(table) + sections;
}

}  // namespace definite
