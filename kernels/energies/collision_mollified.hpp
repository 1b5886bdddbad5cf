#pragma once

// m(c) psi(l) of the distance between two edges, c = |e0 x e1|^2: m = c/ex (2 - c/ex) below the
// threshold c = ex, else 1, so that nothing jumps where edges turn parallel.
//
// Source: m, Li et al. 2020, Incremental Potential Contact; psi and l, Shi & Kim 2023, section 5.2;
// frame and modes, docs/derivations.md, section 4.
// Differs: `analytic` clamps in the frame, of which two blocks of four and three rows have no
// closed form here: Jacobi rotations. Neither Gauss-Newton nor split: m(c) psi(l) is not a penalty
// of one length, and m psi'' grad l grad l^T vanishes for parallel edges, where the Hessian is that
// of c times 2 psi / ex, as large as anywhere.
// Parameters: k, eps, side (as of the unsigned length), ex (a length to the power of four), then
// the penalty's own. By default ex is 1, as k and eps are: 99 % of the pairs of `paper` are below
// it, and 9 % of those of `normal` and `active`.
// Domain: that of the unsigned length of edges, parallel ones too; ex > 0. Inactive where l >= eps.
// Bound: the Hessian's conditioned rounding is at most 50 (docs/protocol.md, section 1).

#include "kernels/energies/collision.hpp"
#include "kernels/lengths/mollified.hpp"
#include "kernels/penalties/cubic.hpp"
#include "kernels/penalties/log_barrier.hpp"
#include "kernels/penalties/quadratic.hpp"

namespace definite {

template <class Penalty>
struct CollisionMollified {
  using Stencil = EdgeEdge;
  using Length = ClosestEdges<Clamped::kEnvelope>;
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr auto kParameters = CollisionParameters<Penalty, 1>(
      Length::kSide, {Parameter{"ex", 1.0, 4, "|e0 x e1|^2 below which the mollifier acts"}});
  static constexpr int kParams = static_cast<int>(kParameters.size());
  static constexpr std::span<const int> kMirror =
      Penalty::kOneSided ? std::span<const int>(Stencil::kMirror) : std::span<const int>();

  static std::string Name() {
    return "collision/" + std::string(Stencil::kName) + "/mollified/" + std::string(Penalty::kName);
  }
  static std::string Source() {
    return "m: Li et al. 2020; " + std::string(Length::kSource) +
           "; psi: " + std::string(Penalty::kSource);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto frame = MollifiedFrameOf(x, p[2]);
    const T l = frame.length.FromUnits(frame.length.l);
    const auto q = Arguments::AsGiven(p);
    const auto idle = (l >= p[1]) | frame.length.outside | Penalty::Outside(l, q) | NoThreshold(p);
    return Select(idle, T(0.0), MollifierOf(frame, p).m * Penalty::Value(l, q));
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto frame = MollifiedFrameOf(x, p[2]);
    const auto& f = frame.length;
    const auto weights = WeightsOf(frame, p);
    const T slope = f.FromUnits(weights.psi_m1 + weights.psi_m1);
    const Vec<T, 4> of_a = {T(-1.0), T(1.0), T(0.0), T(0.0)};
    const Vec<T, 4> of_b = {T(0.0), T(0.0), T(-1.0), T(1.0)};
    return AddKron(AddKron(Kron(f.FromUnits(weights.psi1_m) * OverVertices<Stencil>(f.w), f.n),
                           slope * of_a, frame.slope0),
                   slope * of_b, frame.slope1);
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, kDofs>& x,
                                                    const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const auto q = Arguments::InUnits(f, p);
    const auto outside = f.outside | Penalty::Outside(f.l, q) | NoThreshold(p);
    return {Select((f.l >= q[1]) | outside, T(0.0), T(1.0)), Select(outside, T(0.0), T(1.0)),
            f.region};
  }

  template <Set kSet, Part kPart, class T>
  requires((kSet == Set::kFrame || kSet == Set::kExact) &&
           kPart != Part::kCurvature) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto frame = MollifiedFrameOf(x, p[2]);
    const auto entries = EntriesOf(frame, WeightsOf(frame, p));
    if constexpr (kSet == Set::kFrame) {
      return PullBack(frame, EigenModes(frame, entries));
    } else {
      return PullBack(frame, SumOfModes(frame, entries));
    }
  }

  template <class T>
  static DEFINITE_INLINE auto Nearest(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    return NearestPsdOfFour(HessianModes<Set::kExact, Part::kAll>(x, p));
  }

  template <class T>
  static auto FrameTerms(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto frame = MollifiedFrameOf(x, p[2]);
    const Vec3<T> rows[] = {frame.row0, frame.row1, frame.length.w};
    FrameTerm<T, 9, kDofs, 9> term;
    term.modes = EigenModes(frame, EntriesOf(frame, WeightsOf(frame, p)));
    for (int i = 0; i < 9; ++i) {
      const auto row = OverVertices<Stencil>(rows[i / 3]);
      for (int j = 0; j < kDofs; ++j) {
        term.map[i][j] = j % 3 == i % 3 ? row[j / 3] : T(0.0);
      }
    }
    return std::tuple(term);
  }

 private:
  using Arguments = PenaltyParameters<Penalty, 1>;

  template <class T>
  static DEFINITE_INLINE MaskOf<T> NoThreshold(const Vec<T, kParams>& p) {
    return p[3] <= T(0.0);
  }

  template <class T>
  struct Mollifier {
    T m, m1, cm2, m_c;  // m, m', c m'', m / c
  };
  template <class T>
  static DEFINITE_INLINE Mollifier<T> MollifierOf(const MollifiedFrame<T>& frame,
                                                  const Vec<T, kParams>& p) {
    const auto& f = frame.length;
    const T ex = f.InUnits(f.InUnits(f.InUnits(f.InUnits(Select(NoThreshold(p), T(1.0), p[3])))));
    const auto above = frame.c >= ex;
    const T inverse = T(1.0) / ex;
    const T part = Select(above, T(1.0), frame.c / ex), rest = T(1.0) - part;
    const T slope = (T(1.0) + rest) * inverse;
    return {part * (T(1.0) + rest), (rest + rest) * inverse,
            Select(above, T(0.0), T(-2.0) * (part * inverse)),
            Select(above, T(1.0) / frame.c, slope)};
  }

  // Zero where the energy does not act.
  template <class T>
  static DEFINITE_INLINE MollifiedWeights<T> WeightsOf(const MollifiedFrame<T>& frame,
                                                       const Vec<T, kParams>& p) {
    const auto& f = frame.length;
    const auto q = Arguments::InUnits(f, p);
    const auto idle = (f.l >= q[1]) | f.outside | Penalty::Outside(f.l, q) | NoThreshold(p);
    const Mollifier<T> of_c = MollifierOf(frame, p);
    const T psi = Penalty::Value(f.l, q);
    const Slopes<T> slopes = Penalty::Derivatives(f.l, q);
    const auto unless_idle = [&](const T& weight) { return Select(idle, T(0.0), weight); };
    return {unless_idle(psi * of_c.m1),          unless_idle(psi * of_c.cm2),
            unless_idle(slopes.psi1 * of_c.m1),  unless_idle(slopes.psi1 * of_c.m),
            unless_idle(slopes.psi1 * of_c.m_c), unless_idle(slopes.psi2 * of_c.m)};
  }
};

DEFINITE_ENERGY(CollisionMollified<Quadratic>);
DEFINITE_ENERGY(CollisionMollified<Cubic>);
DEFINITE_ENERGY(CollisionMollified<LogBarrier>);

}  // namespace definite
