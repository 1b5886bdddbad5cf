#pragma once

// Broken filters, one for each property of the contract suite, which must reject it. Each is the
// analytic filter with one mistake.

#include <array>

#include "kernels/energies/collision_signed.hpp"
#include "kernels/filters/analytic.hpp"

namespace definite::testing {

// The analytic filter of signed vertex-face, spoilt after the fact: Spoil::Do gets the packed
// result and the configuration.
template <class Spoil>
struct Spoilt {
  static constexpr std::string_view kName = "analytic";  // its definition is what it claims to be
  static constexpr std::string_view kSource = "an exhibit";
  static constexpr std::array<Exemption, 0> kExempt{};

  template <class E, class T>
  static PackedSym<T, E::kDofs> Apply(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
    PackedSym<T, E::kDofs> f = ToPacked(Analytic::Apply<E>(x, p));
    Spoil::Do(f, x);
    return f;
  }
};

// 0/0 at zero length, as in the printed formulas.
struct DividesByLength {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>& x) {
    const auto frame = Signed<VertexFace>::FrameOf(x, T(0.0));
    for (T& a : f.a) a = (a * frame.l) / frame.l;
  }
};

// Keeps a little of what it should clamp.
struct LeavesNegative {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    f.a[0] = f.a[0] - T(1e-6);
    f.a[12] = f.a[12] - T(1e-6);
    f.a[23] = f.a[23] - T(1e-6);
  }
};

// A constant with too few digits.
struct SinglePrecisionConstant {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    for (T& a : f.a) a = a * T(1.0 + 1e-11);
  }
};

// Another rounding on lanes than on scalars.
struct RoundsLanesOtherwise {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    if constexpr (!std::same_as<T, double>) f.a[40] = f.a[40] * T(1.0 + 0x1p-52);
  }
};

struct TakesTenPercent {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    for (T& a : f.a) a = T(0.9) * a;
  }
};

// Stiffens the z axis of the world.
struct PrefersAnAxis {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    f.a[23] = f.a[23] * T(1.0 + 1e-6);
  }
};

// A tiny mass on one vertex ties it to the world.
struct TiesAVertexDown {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>&) {
    for (int at : {0, 12, 23}) f.a[at] = f.a[at] + T(1e-8);
  }
};

// Calls small triangles degenerate by an absolute threshold.
struct ThresholdsAbsolutely {
  template <class T, int D>
  static void Do(PackedSym<T, D>& f, const Vec<T, D>& x) {
    const auto edges = VertexFace::EdgesOf(x);
    const auto c = Cross(edges.e0, edges.e1);
    const auto small = Dot(c, c) < T(1e-20);
    for (T& a : f.a) a = Select(small, T(0.0), a);
  }
};

using BrokenFilters =
    Filters<Spoilt<DividesByLength>, Spoilt<LeavesNegative>, Spoilt<SinglePrecisionConstant>,
            Spoilt<RoundsLanesOtherwise>, Spoilt<TakesTenPercent>, Spoilt<PrefersAnAxis>,
            Spoilt<TiesAVertexDown>, Spoilt<ThresholdsAbsolutely>>;

}  // namespace definite::testing
