#pragma once

// psi(l) for a length l between two primitives, of lengths/ and penalties/. The combinations that
// make sense are listed in the collision_*.hpp beside this file.
//
// Source: Shi & Kim 2023: frames and modes in lengths/, psi in penalties/.
// Parameters: k (stiffness), eps (activation distance, a length), side (see each length), then the
// penalty's own.
// Domain: that of the length. Inactive where l >= eps.
// Bound: the Hessian's conditioned rounding is at most 50 (docs/protocol.md, section 1).

#include <array>
#include <span>
#include <string>
#include <tuple>

#include "kernels/lengths/collision_frame.hpp"
#include "kernels/lengths/collision_nearest.hpp"
#include "kernels/penalties/penalty.hpp"
#include "kernels/registry.hpp"

namespace definite {

// k, eps, side, then the length's own and the penalty's own.
template <class Penalty, std::size_t kOwn = 0>
constexpr auto CollisionParameters(std::string_view side,
                                   const std::array<Parameter, kOwn>& own = {}) {
  std::array<Parameter, 3 + kOwn + Penalty::kParameters.size()> all = {
      Parameter{"k", 1.0, Penalty::kStiffnessPower, "stiffness"},
      Parameter{"eps", 1.0, 1, "activation distance"},
      Parameter{"side", 0.0, 0, side},
  };
  std::size_t at = 3;
  for (const Parameter& parameter : own) all[at++] = parameter;
  for (const Parameter& parameter : Penalty::kParameters) all[at++] = parameter;
  return all;
}

// Those that psi takes, k, eps and the penalty's own: as given, and in the frame's unit of length.
template <class Penalty, std::size_t kOwn>
struct PenaltyParameters {
  static constexpr int kCount = 2 + static_cast<int>(Penalty::kParameters.size());

  template <class T, int kAll>
  static DEFINITE_INLINE Vec<T, kCount> AsGiven(const Vec<T, kAll>& p) {
    Vec<T, kCount> q;
#pragma GCC unroll 4
    for (int i = 0; i < kCount; ++i) q[i] = p[i < 2 ? i : i + 1 + static_cast<int>(kOwn)];
    return q;
  }
  template <class F, class T, int kAll>
  static DEFINITE_INLINE Vec<T, kCount> InUnits(const F& f, const Vec<T, kAll>& p) {
    constexpr auto kParameters = CollisionParameters<Penalty>({});
    Vec<T, kCount> q = AsGiven(p);
#pragma GCC unroll 4
    for (int i = 0; i < kCount; ++i) {
      const int power = kParameters[static_cast<std::size_t>(i < 2 ? i : i + 1)].length_power;
      if (power < 0) q[i] = f.FromUnits(q[i]);
      for (int k = 0; k < power; ++k) q[i] = f.InUnits(q[i]);
    }
    return q;
  }
};

template <class Length, class Penalty>
struct Collision {
  using Stencil = typename Length::Stencil;
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr auto kParameters = CollisionParameters<Penalty>(Length::kSide);
  static constexpr int kParams = static_cast<int>(kParameters.size());
  static constexpr bool kTurns = Length::kTangents.of[0] != Tangent::kFixed;
  static constexpr std::span<const int> kMirror = [] {
    if constexpr (Penalty::kOneSided && requires { Stencil::kMirror; }) {
      return std::span<const int>(Stencil::kMirror);
    } else {
      return std::span<const int>();
    }
  }();

  static std::string Name() {
    return "collision/" + std::string(Stencil::kName) + "/" + std::string(Length::kName) + "/" +
           std::string(Penalty::kName);
  }
  static std::string Source() {
    return std::string(Length::kSource) + "; psi: " + std::string(Penalty::kSource);
  }

  template <class T>
  static DEFINITE_INLINE auto FrameOf(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    return Length::FrameOf(x, p[2]);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const T l = f.FromUnits(f.l);
    const auto q = Arguments::AsGiven(p);
    return Select((l >= p[1]) | f.outside | Penalty::Outside(l, q), T(0.0), Penalty::Value(l, q));
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    return Kron(f.FromUnits(SlopesAt(f, p).psi1) * OverVertices<Stencil>(f.w), f.n);  // Eq. 16
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, kDofs>& x,
                                                    const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const auto q = Arguments::InUnits(f, p);
    const auto outside = f.outside | Penalty::Outside(f.l, q);
    return {Select((f.l >= q[1]) | outside, T(0.0), T(1.0)), Select(outside, T(0.0), T(1.0)),
            f.region};
  }

  template <Set kSet, Part kPart, class T>
  requires(kSet != Set::kPrinted || requires {
    &Length::template PrintedFrameOf<T>;
  }) static DEFINITE_INLINE auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    if constexpr (kSet == Set::kPrinted) {
      const auto f = Length::PrintedFrameOf(x, p[2]);
      const auto q = Arguments::AsGiven(p);
      const auto slopes = SlopesAt(f.l, q, (f.l >= q[1]) | Penalty::Outside(f.l, q));
      return Length::PrintedModes(f, slopes.psi1, slopes.psi2);
    } else {
      // Rows of the frame over a short edge are long and cancel; those turned are orthogonal.
      constexpr Set kUsed = kSet == Set::kExact && kTurns ? Set::kSplit : kSet;
      return PendingModes<kUsed, T>(x, p).template OfPart<kPart>();
    }
  }

  // The same in two stages: the frame of a set, and its modes.
  template <Set kSet, class T>
  class PendingModes {
   public:
    DEFINITE_INLINE PendingModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p)
        : f_(Length::FrameOf(x, p[2])), slopes_(SlopesAt(f_, p)) {
      if constexpr (kSet == Set::kSplit) TurnInX<Length::kTangents>(f_);
    }

    template <Part kPart>
    DEFINITE_INLINE auto OfPart() const {
      constexpr bool kTriangular =
          kSet != Set::kSplit && Length::kTangents.of[0] != Tangent::kByRegion;
      return PullBack<kTriangular>(f_, ModesOf<kSet, kPart>(f_, slopes_));
    }

   private:
    decltype(Length::FrameOf(Vec<T, kDofs>(), T())) f_;
    Slopes<T> slopes_;
  };

  // The nearest PSD matrix, in stages (collision_nearest.hpp).
  template <class T>
  requires(kTurns) static DEFINITE_INLINE
      auto BeginNearest(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const auto slopes = SlopesAt(f, p);
    return Projection<T>(f, TurnedRowsOf<Length::kTangents>(f), slopes.psi1, slopes.psi2);
  }
  // Without a free tangent all modes are orthogonal already.
  template <class T>
  requires(!kTurns) static DEFINITE_INLINE
      auto Nearest(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    auto modes = HessianModes<Set::kSplit, Part::kPositive>(x, p);
    MapWeights(modes, [](const T& lambda) { return Max(T(0.0), lambda); });
    return modes;
  }

  // The Hessian as the paper assembles it: map^T H map summed over one or two terms (Eq. 17), each
  // with its modes in the frame coordinates c.
  template <class T>
  static auto FrameTerms(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const auto slopes = SlopesAt(f, p);
    if constexpr (kSplits) {
      // psi'/l on both tangents; the second term has the opposite sign and the map D.
      const auto first = PairModes<Part::kAll, kBothFixed>(f, slopes.psi1, slopes.psi2);
      const auto second = PairModes<Part::kAll, kBothFixed>(f, -slopes.psi1, T(0.0));
      auto terms = std::tuple(ToFrameTerm(f, first), ToFrameTerm(f, second));
      Length::Remainder(x, f.outside, std::get<1>(terms).map);
      return terms;
    } else {
      return std::tuple(ToFrameTerm(f, ModesOf<Set::kFrame, Part::kAll>(f, slopes)));
    }
  }

 private:
  using Arguments = PenaltyParameters<Penalty, 0>;
  template <class T>
  using Projection =
      CollisionProjection<Stencil, Length::kTangents,
                          decltype(Length::FrameOf(Vec<T, kDofs>(), T()))::kFreeSlots, T>;

  // A length whose frame set is not its pairs of free modes.
  static constexpr bool kSplits = requires(CollisionFrame<double, Stencil, 2> f) {
    Length::template SplitModes<Part::kAll>(f, 0.0, 0.0);
  };

  template <Set kSet, Part kPart, class F, class S>
  static DEFINITE_INLINE auto ModesOf(const F& f, const S& slopes) {
    if constexpr (kSet == Set::kFrame && kSplits) {
      return Length::template SplitModes<kPart>(f, slopes.psi1, slopes.psi2);
    } else {
      return PairModes<kPart, Length::kTangents>(f, slopes.psi1, slopes.psi2);
    }
  }

  // psi'/unit and psi'', zero where the energy does not act.
  template <class F, class T>
  static DEFINITE_INLINE Slopes<T> SlopesAt(const F& f, const Vec<T, kParams>& p) {
    const auto q = Arguments::InUnits(f, p);
    return SlopesAt(f.l, q, (f.l >= q[1]) | f.outside | Penalty::Outside(f.l, q));
  }
  template <class T>
  static DEFINITE_INLINE Slopes<T> SlopesAt(const T& l, const Vec<T, Arguments::kCount>& q,
                                            const MaskOf<T>& idle) {
    const Slopes<T> slopes = Penalty::Derivatives(l, q);
    return {Select(idle, T(0.0), slopes.psi1), Select(idle, T(0.0), slopes.psi2)};
  }
};

}  // namespace definite
