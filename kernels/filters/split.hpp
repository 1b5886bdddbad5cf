#pragma once

// Clamp in x-space: the geometric term in orthogonal vectors, each clamped, and the curvature. As
// cheap in terms as the paper's filter, nearer to the projection, and blind to the numbering.
//
// Source: docs/derivations.md, section 1.

#include <array>

#include "kernels/registry.hpp"

namespace definite {

struct Split {
  static constexpr std::string_view kName = "split";
  static constexpr std::string_view kSource = "docs/derivations.md, section 1";
  static constexpr bool kOutputs = true, kStages = true;
  static constexpr std::array<Exemption, 0> kExempt{};

  template <class E, class T>
  requires OffersSet<E, T, Set::kSplit>
  static DEFINITE_INLINE auto Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    auto modes = E::template HessianModes<Set::kSplit, Part::kPositive>(x, p);
    MapWeights(modes, [](const T& lambda) { return Max(T(0.0), lambda); });
    return modes;
  }

  // The same in stages, where the energy has them: turning the frame is half of the work.
  template <class E, class T>
  requires requires { typename E::template PendingModes<Set::kSplit, T>; }
  static DEFINITE_INLINE auto Begin(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    return Clamped<typename E::template PendingModes<Set::kSplit, T>, T>(x, p);
  }

 private:
  template <class Pending, class T>
  struct Clamped : Pending {
    static constexpr int kRefinements = 0;
    template <class X, class P>
    DEFINITE_INLINE Clamped(const X& x, const P& p) : Pending(x, p) {}
    void Refine(int) {}
    DEFINITE_INLINE auto Result() const {
      auto modes = this->template OfPart<Part::kPositive>();
      MapWeights(modes, [](const T& lambda) { return Max(T(0.0), lambda); });
      return SumOf(modes);
    }
  };
};

DEFINITE_FILTER(Split);

}  // namespace definite
