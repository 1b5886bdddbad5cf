#pragma once

// An isotropic distortion energy of a triangle in the plane or a tetrahedron: psi of the principal
// stretches of F = Ds R, where the columns of Ds are the edges from x0 and R is the inverse of the
// rest shape's. psi is the energy of the element: its density times the rest area or volume, which
// is in the parameters.
//
// Source: Smith, de Goes and Kim 2019, sections 2 to 5; Algorithm 1 for F, dF/dx.
// Differs: one theorem for all psi (stretches.hpp) in place of invariants, in forms that divide by
// no difference of stretches; rank-one modes in x in place of (dF/dx)^T H dF/dx.
// Shapes: x is D + 1 vertices of D coordinates; p is R row by row, and then psi's own parameters.
// Domain: |F_ij| < 2^100, and where psi is defined (Stretchable). Always active.

#include <array>
#include <string>
#include <tuple>

#include "kernels/core/jacobi.hpp"
#include "kernels/core/symmetric2.hpp"
#include "kernels/distortion/stretches.hpp"
#include "kernels/distortion/svd.hpp"
#include "kernels/registry.hpp"
#include "kernels/stencils/tetrahedron.hpp"
#include "kernels/stencils/triangle.hpp"

namespace definite {

inline constexpr double kMostStretch = 0x1p100;

template <int D>
inline constexpr std::string_view kRestNames[] = {"rest_00", "rest_01", "rest_10", "rest_11"};
template <>
inline constexpr std::string_view kRestNames<3>[] = {"rest_00", "rest_01", "rest_02",
                                                     "rest_10", "rest_11", "rest_12",
                                                     "rest_20", "rest_21", "rest_22"};

template <class Simplex, class Psi>
struct Distortion {
  using Stencil = Simplex;
  static constexpr int kD = Simplex::kDimension, kDofs = Simplex::kDofs, kPairs = kStretchPairs<kD>;
  static constexpr int kF = kD * kD, kModes = kF;
  static constexpr int kParams = kF + static_cast<int>(std::size(Psi::kParameters));
  static constexpr std::array<Parameter, kParams> kParameters = [] {
    std::array<Parameter, kParams> all{};
    for (std::size_t i = 0; i < kParams; ++i) {
      all[i] = i < kF ? Parameter{kRestNames<kD>[i], i % (kD + 1) == 0 ? 1.0 : 0.0, -1,
                                  "entry of the inverse of the rest shape's edges, in columns"}
                      : Psi::kParameters[i - kF];
    }
    return all;
  }();
  // Of an energy that is not defined for an inverted element: two vertices exchanged.
  static constexpr auto kMirror = [] {
    std::array<int, Psi::kDomain == Stretchable::kNotInverted ? kD + 1 : 0> order{};
    for (std::size_t i = 0; i < order.size(); ++i)
      order[i] = i < 2 ? static_cast<int>(1 - i) : static_cast<int>(i);
    return order;
  }();

  static std::string Name() {
    return std::string("distortion/").append(Simplex::kName).append("/").append(Psi::kName);
  }
  static std::string Source() { return std::string(Psi::kSource); }

  template <class T>
  static T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Shape<T> shape = ShapeOf(x, p);
    return Select(shape.outside, T(0.0), Psi::Value(shape.s, &p[kF]));
  }

  template <class T>
  static Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Shape<T> shape = ShapeOf(x, p);
    const Vec<T, kD> slopes = Psi::Slopes(shape.s, &p[kF]);
    const auto outer = OverVertices(shape, p);
    Vec<T, kDofs> g = Select(shape.outside, T(0.0), slopes[0]) * outer(0, 0);
    for (int i = 1; i < kD; ++i) g = g + Select(shape.outside, T(0.0), slopes[i]) * outer(i, i);
    return g;
  }

  template <class T>
  static Classification<T> Classify(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const T inside = Select(ShapeOf(x, p).outside, T(0.0), T(1.0));
    return {inside, inside, T(0.0)};
  }

  // Of a sum of squares.
  template <class T>
  static constexpr bool kHasCurvature = requires(const Vec<T, kD>& s, const T* p) {
    Psi::ScalingCurvature(s, p);
  };

  template <Set kSet, Part kPart, class T>
  requires((kSet == Set::kFrame || kSet == Set::kExact) &&
           (kPart != Part::kCurvature || kHasCurvature<T>)) static DEFINITE_INLINE
      auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Shape<T> shape = ShapeOf(x, p);
    return ModesOver<kPart, kDofs>(shape, p, OverVertices(shape, p));
  }

  // The whole of it: c = F, column by column.
  template <class T>
  static auto FrameTerms(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Shape<T> shape = ShapeOf(x, p);
    FrameTerm<T, kF, kDofs, kModes> term;
    term.modes = ModesOver<Part::kAll, kF>(shape, p, [&shape](int a, int b) {
      Vec<T, kF> v;
      for (int j = 0; j < kD; ++j) {
        for (int i = 0; i < kD; ++i) v[j * kD + i] = shape.svd.u[a][i] * shape.svd.v[b][j];
      }
      return v;
    });
    // Twists and flips as unit vectors.
    const T unit = Sqrt(T(0.5));
    for (int m = kD; m < kModes; ++m) {
      term.modes.lambda[m] = T(2.0) * term.modes.lambda[m];
      term.modes.v[m] = unit * term.modes.v[m];
    }
    for (int c = 0; c < kF; ++c) {
      for (int i = 0; i < kDofs; ++i) term.map[c][i] = T(0.0);
      for (int k = 0; k < kD; ++k) {
        const T& rest = p[k * kD + c / kD];
        term.map[c][(k + 1) * kD + c % kD] = rest;
        term.map[c][c % kD] = term.map[c][c % kD] - rest;
      }
    }
    return std::tuple{term};
  }

  // What Stomakhin et al. 2012 make of first derivatives: [[a, b], [b, a]] over u_j v_k^T and
  // u_k v_j^T for each pair j < k, in their order.
  template <class T>
  struct Blocks {
    Vec<T, kD> u[kD], v[kD];
    PackedSym<T, kD> scaling;
    Vec<T, 2> pairs[kPairs];
  };
  template <class T>
  static Blocks<T> StretchBlocks(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const Shape<T> shape = ShapeOf(x, p);
    const T inside = Select(shape.outside, T(0.0), T(1.0));
    const Vec<T, kD> slopes = inside * Psi::Slopes(shape.s, &p[kF]);
    Blocks<T> blocks;
    for (int i = 0; i < kD; ++i) {
      blocks.u[i] = shape.svd.u[i];
      blocks.v[i] = shape.svd.v[i];
    }
    blocks.scaling = Packed(Psi::Scaling(shape.s, &p[kF]));
    for (T& entry : blocks.scaling.a) entry = inside * entry;
    // How far from 0 they keep denominators is not in the paper: this is ours.
    const auto over = [](const T& a, const T& b) {
      const T least = T(1e-6), magnitude = Max(least, Abs(b));
      return a / Select(b < T(0.0), -magnitude, magnitude);
    };
    int at = 0;
    for (int j = 0; j < kD; ++j) {
      for (int k = j + 1; k < kD; ++k) {
        const T twist = over(slopes[j] + slopes[k], shape.s[j] + shape.s[k]);
        const T flip = over(slopes[j] - slopes[k], shape.s[j] - shape.s[k]);
        blocks.pairs[at++] = {T(0.5) * (flip + twist), T(0.5) * (flip - twist)};
      }
    }
    return blocks;
  }

  // A pull-back has as many positive eigenvalues as there are positive modes: where there is none,
  // as in a collapsed element of St. Venant and Kirchhoff, the answer is 0 and not its rounding.
  // Twists of collapsed elements outweigh all others, and come first.
  template <class T>
  static auto Nearest(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto modes = HessianModes<Set::kExact, Part::kAll>(x, p);
    T most = modes.lambda[0], rest = T(0x1p-1022);
    for (int m = 1; m < kModes; ++m) most = Max(modes.lambda[m], most);
    for (int i = 0; i < kF; ++i) rest = Max(Abs(p[i]), rest);
    // Vectors in units of the rest shape's, for they are squared.
    const T unit = InversePowerOfTwo(rest), back = T(1.0) / unit;
    Modes<T, kDofs, kModes> first;
    for (int m = 0; m < kModes; ++m) {
      const int from = (m + kD) % kModes;
      const T weight = back * (back * modes.lambda[from]);
      first.lambda[m] = Select(most <= T(0.0), T(0.0), weight);
      first.v[m] = unit * modes.v[from];
    }
    if constexpr (kD == 3) {
      return NearestPsdOfFour<3>(first);
    } else {
      return NearestPsd(first);
    }
  }

 private:
  template <class T>
  struct Shape {
    MaskOf<T> outside;
    RotationSvd<T, kD> svd;
    Vec<T, kD> s;  // 1 outside
  };

  template <class T>
  static Shape<T> ShapeOf(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    static_assert(StretchEnergy<Psi, T, kD>);
    Vec<T, kD> f[kD];
    T magnitude = T(0.0);
    for (int j = 0; j < kD; ++j) {
      for (int i = 0; i < kD; ++i) {
        f[j][i] = (x[kD + i] - x[i]) * p[j];
        for (int k = 1; k < kD; ++k)
          f[j][i] = MulAdd(x[(k + 1) * kD + i] - x[i], p[k * kD + j], f[j][i]);
        magnitude = Max(Abs(f[j][i]), magnitude);
      }
    }
    const auto beyond = magnitude >= T(kMostStretch);
    for (int j = 0; j < kD; ++j) {
      for (int i = 0; i < kD; ++i) f[j][i] = Select(beyond, T(i == j ? 1.0 : 0.0), f[j][i]);
    }
    Shape<T> shape;
    shape.svd = SvdOf<T, kD>(f);
    shape.outside = beyond | IsUndefined(shape.svd.s);
    shape.s = Each(shape.svd.s, [&](const T& s) { return Select(shape.outside, T(1.0), s); });
    return shape;
  }

  template <class T>
  static auto IsUndefined(const Vec<T, kD>& s) {
    const T tau = T(kTau);
    if constexpr (Psi::kDomain == Stretchable::kAlways) {
      return s[0] > T(2.0 * kD * kMostStretch);  // never
    } else if constexpr (Psi::kDomain == Stretchable::kWithRotation) {
      // A NaN is not outside: it stays one.
      if constexpr (kD == 2)
        return s[0] + s[1] <= tau * Sqrt(Dot(s, s));
      else {
        const T sum = Sum(s);
        return ((s[0] + s[1]) * (s[1] + s[2])) * (s[2] + s[0]) <= (tau * sum) * (sum * sum);
      }
    } else {
      Vec<T, kD> others;
      for (int i = 0; i < kD; ++i) others[i] = OthersOf(s, i);
      return Product(s) <= (tau * Sqrt(Dot(s, s))) * Sqrt(Dot(others, others));
    }
  }

  // (a, b) -> u_a v_b^T pulled back: u_a (x) the weights of R v_b over the vertices.
  template <class T>
  static DEFINITE_INLINE auto OverVertices(const Shape<T>& shape, const Vec<T, kParams>& p) {
    std::array<Vec<T, kD + 1>, kD> weights;
    for (int b = 0; b < kD; ++b) {
      Vec<T, kD + 1>& w = weights[static_cast<std::size_t>(b)];
      w[0] = T(0.0);
      for (int k = 0; k < kD; ++k) {
        w[k + 1] = p[k * kD] * shape.svd.v[b][0];
        for (int j = 1; j < kD; ++j) w[k + 1] = MulAdd(p[k * kD + j], shape.svd.v[b][j], w[k + 1]);
        w[0] = w[0] - w[k + 1];
      }
    }
    return [weights, &shape](int a, int b) {
      Vec<T, kDofs> r;
      for (int vertex = 0; vertex <= kD; ++vertex) {
        for (int i = 0; i < kD; ++i) {
          r[vertex * kD + i] = weights[static_cast<std::size_t>(b)][vertex] * shape.svd.u[a][i];
        }
      }
      return r;
    };
  }

  // Scaling, then a mode for each twist, then for each flip, over the vectors outer(a, b) that
  // stand for u_a v_b^T.
  template <Part kPart, int N, class T, class Outer>
  static DEFINITE_INLINE Modes<T, N, kModes> ModesOver(const Shape<T>& shape,
                                                       const Vec<T, kParams>& p, Outer outer) {
    const T* own = &p[kF];
    Modes<T, N, kModes> modes;
    if constexpr (kPart == Part::kCurvature) {
      SetScaling(modes, Psi::ScalingCurvature(shape.s, own), outer);
    } else {
      SetScaling(modes, Psi::Scaling(shape.s, own), outer);
    }
#pragma GCC unroll 3
    for (int pair = 0; pair < kPairs; ++pair) {
      const auto stretches = PairOf<kD>(shape.s, pair);
      const Vec<T, N> jk = outer(FirstOf<kD>(pair), SecondOf<kD>(pair)),
                      kj = outer(SecondOf<kD>(pair), FirstOf<kD>(pair));
      Modes<T, 2, 2> two;  // over (u_j v_k^T, u_k v_j^T)
      if constexpr (kPart == Part::kCurvature) {
        two = Psi::PairCurvature(shape.s, stretches, own);
        modes.v[kD + pair] = two.v[0][0] * jk + two.v[0][1] * kj;
        modes.v[kD + kPairs + pair] = two.v[1][0] * jk + two.v[1][1] * kj;
        modes.lambda[kD + pair] = two.lambda[0];
        modes.lambda[kD + kPairs + pair] = two.lambda[1];
      } else {
        // The halves are the squares of 1/sqrt 2.
        modes.lambda[kD + pair] = T(0.5) * Psi::Twist(shape.s, stretches, own);
        modes.v[kD + pair] = kj - jk;
        modes.lambda[kD + kPairs + pair] = T(0.5) * Psi::Flip(shape.s, stretches, own);
        modes.v[kD + kPairs + pair] = kj + jk;
      }
    }
    MapWeights(modes, [&shape](const T& lambda) { return Select(shape.outside, T(0.0), lambda); });
    return modes;
  }

  template <class T>
  static PackedSym<T, kD> Packed(const Vec<T, kD>& diagonal) {
    return SymmetricOf<kD>([&](int i, int j) { return i == j ? diagonal[i] : T(0.0); });
  }
  template <class T>
  static PackedSym<T, kD> Packed(const Modes<T, kD, kD>& modes) {
    return ToPacked(modes);
  }
  template <class T>
  static PackedSym<T, kD> Packed(const PackedSym<T, kD>& a) {
    return a;
  }

  template <int N, class T, class Outer>
  static DEFINITE_INLINE void SetScaling(Modes<T, N, kModes>& modes, const Vec<T, kD>& diagonal,
                                         Outer outer) {
    for (int m = 0; m < kD; ++m) {
      modes.lambda[m] = diagonal[m];
      modes.v[m] = outer(m, m);
    }
  }
  template <int N, class T, class Outer>
  static DEFINITE_INLINE void SetScaling(Modes<T, N, kModes>& modes, const Modes<T, kD, kD>& known,
                                         Outer outer) {
    Vec<T, N> axes[kD];
    for (int i = 0; i < kD; ++i) axes[i] = outer(i, i);
    for (int m = 0; m < kD; ++m) {
      modes.lambda[m] = known.lambda[m];
      modes.v[m] = known.v[m][0] * axes[0];
      for (int i = 1; i < kD; ++i) modes.v[m] = modes.v[m] + known.v[m][i] * axes[i];
    }
  }
  template <int N, class T, class Outer>
  static DEFINITE_INLINE void SetScaling(Modes<T, N, kModes>& modes, const PackedSym<T, kD>& a,
                                         Outer outer) {
    // In units of a power of two, for a stiffness may be far from 1, and rotations square it.
    T largest = T(0x1p-1022);
    for (const T& entry : a.a) largest = Max(Abs(entry), largest);
    const T scale = InversePowerOfTwo(largest);
    T full[kD][kD];
    int k = 0;
    for (int i = 0; i < kD; ++i) {
      for (int j = i; j < kD; ++j) full[i][j] = scale * a.a[k++];
    }
    Modes<T, kD, kD> known;
    if constexpr (kD == 2) {
      const auto e = SymmetricEigen2(full[0][0], full[0][1], full[1][1]);
      known = {{e.first, e.second}, {{e.c, e.s}, {-e.s, e.c}}};
    } else {
      const EigenSystem<T, kD> e = JacobiEigen(full);
      for (int m = 0; m < kD; ++m) {
        known.lambda[m] = e.values[m];
        for (int i = 0; i < kD; ++i) known.v[m][i] = e.vectors[i][m];
      }
    }
    const T back = T(1.0) / scale;
    MapWeights(known, [&back](const T& lambda) { return back * lambda; });
    SetScaling(modes, known, outer);
  }
};

}  // namespace definite
