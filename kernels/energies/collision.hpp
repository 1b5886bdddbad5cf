#pragma once

// psi(l) for a length l between two primitives, of lengths/ and penalties/. The combinations that
// make sense are listed in the collision_*.hpp beside this file.
//
// Source: Shi & Kim 2023: frames and modes in lengths/, psi in penalties/.
// Parameters: k (stiffness), eps (activation distance, a length), side (see each length).
// Domain: that of the length. Inactive where l >= eps.
// Bound: the Hessian's conditioned rounding is at most 50 (docs/protocol.md, section 1).

#include <string>
#include <tuple>

#include "kernels/lengths/collision_frame.hpp"
#include "kernels/registry.hpp"

namespace definite {

template <class Length, class Penalty>
struct Collision {
  using Stencil = typename Length::Stencil;
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr int kParams = 3;
  static constexpr Parameter kParameters[] = {
      {"k", 1.0, 0, "stiffness"},
      {"eps", 1.0, 1, "activation distance"},
      {"side", 0.0, 0, Length::kSide},
  };

  static std::string Name() {
    return "collision/" + std::string(Stencil::kName) + "/" + std::string(Length::kName) + "/" +
           std::string(Penalty::kName);
  }
  static std::string Source() {
    return std::string(Length::kSource) + "; psi: " + std::string(Penalty::kSource);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const T l = f.FromUnits(f.l);
    return Select((l >= p[1]) | f.outside, T(0.0), Penalty::Value(l, p[0], p[1]));
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x,
                                                const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    return Kron(f.FromUnits(Slopes(f, p).psi1) * f.w, f.n);  // Eq. 16
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, kDofs>& x,
                                                    const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    return {Select((f.l >= f.InUnits(p[1])) | f.outside, T(0.0), T(1.0)),
            Select(f.outside, T(0.0), T(1.0)), f.region};
  }

  template <Set kSet, Part kPart, class T>
    requires(kSet != Set::kPrinted || requires { &Length::template PrintedFrameOf<T>; })
  static DEFINITE_INLINE auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    if constexpr (kSet == Set::kPrinted) {
      const auto f = Length::PrintedFrameOf(x, p[2]);
      const auto slopes = Slopes(f.l, p[0], p[1], f.l >= p[1]);
      return Length::PrintedModes(f, slopes.psi1, slopes.psi2);
    } else {
      const auto f = Length::FrameOf(x, p[2]);
      return PullBack(f, ModesOf<kSet, kPart>(f, Slopes(f, p)));
    }
  }

  // The Hessian as the paper assembles it: map^T H map summed over one or two terms (Eq. 17), each
  // with its modes in the frame coordinates c.
  template <class T>
  static auto FrameTerms(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const auto slopes = Slopes(f, p);
    if constexpr (kSplits) {
      // psi'/l on both tangents; the second term has the opposite sign and the map D.
      const auto first = PairModes<Part::kAll, Tangents::kFixed>(f, slopes.psi1, slopes.psi2);
      const auto second = PairModes<Part::kAll, Tangents::kFixed>(f, -slopes.psi1, T(0.0));
      auto terms = std::tuple(FrameTerm<T, 9, kDofs, 3>{InFrame(f, first), {}},
                              FrameTerm<T, 9, kDofs, 3>{InFrame(f, second), {}});
      FrameMap(f, std::get<0>(terms).map);
      Length::Remainder(x, f.outside, std::get<1>(terms).map);
      return terms;
    } else {
      const auto modes = ModesOf<Set::kFrame, Part::kAll>(f, slopes);
      FrameTerm<T, 9, kDofs, std::size(decltype(modes.mode){})> term{InFrame(f, modes), {}};
      FrameMap(f, term.map);
      return std::tuple(term);
    }
  }

 private:
  // A length whose frame set is not its pairs of free modes.
  static constexpr bool kSplits = requires(CollisionFrame<double> f) {
    Length::template SplitModes<Part::kAll>(f, 0.0, 0.0);
  };

  template <Set kSet, Part kPart, class T, class S>
  static DEFINITE_INLINE auto ModesOf(const CollisionFrame<T>& f, const S& slopes) {
    if constexpr (kSet == Set::kFrame && kSplits) {
      return Length::template SplitModes<kPart>(f, slopes.psi1, slopes.psi2);
    } else {
      return PairModes<kPart, Length::kTangents>(f, slopes.psi1, slopes.psi2);
    }
  }

  // S, Eq. 19.
  template <class T>
  static void FrameMap(const CollisionFrame<T>& f, T (&map)[9][12]) {
    const Vec<T, 4> rows[3] = {f.rows[0], f.rows[1], f.w};
    for (int slot = 0; slot < 3; ++slot) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 12; ++j) map[3 * slot + i][j] = j % 3 == i ? rows[slot][j / 3] : T(0.0);
      }
    }
  }

  // psi'/unit and psi'', zero where the energy does not act.
  template <class T>
  static DEFINITE_INLINE auto Slopes(const CollisionFrame<T>& f, const Vec<T, kParams>& p) {
    const T eps = f.InUnits(p[1]);
    return Slopes(f.l, p[0], eps, (f.l >= eps) | f.outside);
  }
  template <class T>
  static DEFINITE_INLINE auto Slopes(const T& l, const T& k, const T& eps, const MaskOf<T>& idle) {
    auto slopes = Penalty::Derivatives(l, k, eps);
    slopes.psi1 = Select(idle, T(0.0), slopes.psi1);
    slopes.psi2 = Select(idle, T(0.0), slopes.psi2);
    return slopes;
  }
};

}  // namespace definite
