#pragma once

// The nearest PSD matrix to the Hessian of psi(l), for every length with a frame.
//
// Source: docs/derivations.md, section 2. In the orthonormal vectors v_k (x) n, (w/|w|) (x) u_k of
// the split set and the rest of w along n, the Hessian is a matrix of 2 S + 1 rows, S the number of
// tangents that may be free: 2x2 blocks with known eigenvalues, and psi'' z z^T. Its eigenvalues,
// S of them negative and S + 1 positive, are roots of a secular equation. The result is the Hessian
// less what is negative; but where that is most of the matrix, which would cost the rest its
// digits, it is made of the positive ones alone. Either way its error is relative to itself. A
// fixed tangent is an eigenvector of its own.
// Shapes and units: as in collision_frame.hpp.

#include "kernels/core/laguerre.hpp"
#include "kernels/core/secular.hpp"
#include "kernels/lengths/collision_frame.hpp"

namespace definite {

// The square of what is left of w beside the rows v of a frame. If both slots are free these span
// all rows that sum to zero but one, and it is a constant of the stencil: a difference would lose
// digits where the foot point is far away.
template <class Stencil, bool kConstant, class T, int kSlots>
DEFINITE_INLINE T RestOfRow(const Vec<T, Stencil::kEdges>& w,
                            const Vec<T, Stencil::kEdges> (&v)[kSlots], const T (&s)[kSlots]) {
  if constexpr (kConstant) {
    constexpr int kLast = Stencil::kEdges - 1;
    return T(double{internal::GramDeterminant<Stencil>(kLast + 1)}) /
           T(double{internal::GramDeterminant<Stencil>(kLast)});
  } else {
    auto rest = w;
    for (int k = 0; k < kSlots; ++k) rest = rest - s[k] * v[k];
    const auto over_vertices = OverVertices<Stencil>(rest);
    return Dot(over_vertices, over_vertices);
  }
}

// The Hessian in the orthonormal vectors: for slot k the block [[a, b], [b, 0]] on v_k (x) n and
// (w/|w|) (x) u_k, and psi'' z z^T, z the parts of w along the rows.
template <class T, int kSlots>
struct ReducedHessian {
  static constexpr int kPoles = 2 * kSlots + 1;

  T a[kSlots], b[kSlots], b2[kSlots];
  T s[kSlots], rest2;  // of w along v_k, and what is left, squared
  T curvature;
  SecularEquation<T, kPoles> equation;

  // The eigenvalues are the roots of x^kPoles + c[kPoles - 1] x^(kPoles - 1) + ... + c[0].
  DEFINITE_INLINE void Polynomial(T (&c)[kPoles]) const {
    const T r = curvature * rest2;
    T z[kSlots];
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) z[k] = curvature * (s[k] * s[k]);
    if constexpr (kSlots == 1) {
      c[0] = r * b2[0];
      c[1] = MulAdd(r, a[0], -b2[0]);
      c[2] = -(a[0] + (z[0] + r));
    } else {
      // The product of both blocks' polynomials is x^4 - e3 x^3 + e2 x^2 + e1 x + e0.
      const T e0 = b2[0] * b2[1], e1 = MulAdd(a[0], b2[1], a[1] * b2[0]);
      const T e2 = MulAdd(a[0], a[1], -(b2[0] + b2[1])), e3 = a[0] + a[1];
      c[0] = -(r * e0);
      c[1] = e0 - r * e1;
      c[2] = MulAdd(z[0], b2[1], MulAdd(z[1], b2[0], e1 - r * e2));
      c[3] = MulAdd(z[0], a[1], MulAdd(z[1], a[0], MulAdd(r, e3, e2)));
      c[4] = -((e3 + r) + (z[0] + z[1]));
    }
  }
};

// Eigenvalues over the squared length of an eigenvector of each.
template <class T, int kSlots, int K>
struct ReducedPairs {
  T value[K], weight[K];
  T along_n[K][kSlots + 1];  // v_k (x) n, and the rest (x) n
  T along_u[K][kSlots];
};

// Of the roots of h's secular equation.
template <int K, class T, int kSlots>
DEFINITE_INLINE ReducedPairs<T, kSlots, K> PairsOf(
    const ReducedHessian<T, kSlots>& h, const SecularRoots<T, 2 * kSlots + 1, K>& roots) {
  ReducedPairs<T, kSlots, K> pairs;
  T inverse_squared[K];
#pragma GCC unroll 3
  for (int i = K - 1; i >= 0; --i) {
    // Scaled: the rest (x) n, and in each block (mu, B) mu s / ((d- - mu)(d+ - mu)).
    const auto& [mu, to_pole] = roots.root[i];
    pairs.value[i] = mu;
    pairs.along_n[i][kSlots] = T(1.0);
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      const T part = h.s[k] * mu / (to_pole[k] * to_pole[2 * kSlots - k]);
      pairs.along_n[i][k] = part * mu;
      pairs.along_u[i][k] = part * h.b[k];
    }
    // Where a weight is tiny and a root almost its pole, a pair of vectors spans the right plane
    // and need not be orthogonal.
#pragma GCC unroll 3
    for (int j = K - 1; j > i; --j) {
      T along = h.rest2 * (pairs.along_n[i][kSlots] * pairs.along_n[j][kSlots]);
#pragma GCC unroll 2
      for (int k = 0; k < kSlots; ++k) {
        along = MulAdd(pairs.along_n[i][k], pairs.along_n[j][k], along);
        along = MulAdd(pairs.along_u[i][k], pairs.along_u[j][k], along);
      }
      along = along * inverse_squared[j];
#pragma GCC unroll 3
      for (int k = 0; k <= kSlots; ++k) {
        pairs.along_n[i][k] = pairs.along_n[i][k] - along * pairs.along_n[j][k];
      }
#pragma GCC unroll 2
      for (int k = 0; k < kSlots; ++k) {
        pairs.along_u[i][k] = pairs.along_u[i][k] - along * pairs.along_u[j][k];
      }
    }
    T squared = h.rest2 * (pairs.along_n[i][kSlots] * pairs.along_n[i][kSlots]);
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      squared = MulAdd(pairs.along_n[i][k], pairs.along_n[i][k], squared);
      squared = MulAdd(pairs.along_u[i][k], pairs.along_u[i][k], squared);
    }
    inverse_squared[i] = T(1.0) / squared;
    pairs.weight[i] = mu * inverse_squared[i];
  }
  return pairs;
}

// The projection in stages, so that over lanes the long chain of operations of one configuration
// runs beside those of others: begun with the frame and psi's derivatives, then kRefinements times
// refined.
template <class FrameStencil, Tangents kTangents, int kSlots, class T>
class CollisionProjection {
 public:
  using Stencil = FrameStencil;
  static constexpr int kVertices = Stencil::kVertices;
  static constexpr int kRefinements = 5;

  CollisionProjection() = default;
  DEFINITE_INLINE CollisionProjection(const CollisionFrame<T, Stencil, kSlots>& f,
                                      const TurnedRows<T, Stencil, kSlots>& turned, const T& psi1,
                                      const T& psi2);

  // All but the last step with half the digits, which is all that it is good for.
  DEFINITE_INLINE void Refine(int step) {
    Refine(step + 1 == kRefinements, std::make_integer_sequence<int, kSlots>());
  }

  DEFINITE_INLINE FramedSum<T, Stencil, true> Result() const;

 private:
  static constexpr bool kByRegion = kTangents.of[0] == Tangent::kByRegion;
  static constexpr int kPoles = 2 * kSlots + 1, kLast = Stencil::kEdges - 1;
  static constexpr int kFixed = kByRegion ? 2 : 2 - kSlots;  // tangents that may be fixed
  using Low = typename LowPrecision<T>::Type;

  template <int... k>
  DEFINITE_INLINE void Refine(bool last, std::integer_sequence<int, k...>) {
    if (last) {
      const T x[kSlots] = {LowPrecision<T>::Back(low_root_[k])...};
      ((root_[k] = x[k] - LowPrecision<T>::Back(LaguerreStep<k>(x[k], polynomial_))), ...);
    } else {
      ((low_root_[k] = low_root_[k] - LaguerreStep<k>(low_root_[k], low_polynomial_)), ...);
    }
  }

  // sign sum_i weight_i y_i y_i^T is added.
  template <int K>
  DEFINITE_INLINE void Add(const ReducedPairs<T, kSlots, K>& pairs, const T& sign,
                           FramedSum<T, Stencil, true>& sum) const;

  ReducedHessian<T, kSlots> h_;
  T polynomial_[kPoles];
  Low low_polynomial_[kPoles], low_root_[kSlots];
  T root_[kSlots];                         // near the negative eigenvalues
  T trace_, unit_;                         // of h_, and what it is in units of
  Vec<T, Stencil::kEdges> w_, v_[kSlots];  // rows over the edges
  Vec3<T> n_, u_[kSlots];                  // u over |w|
  T fixed_weight_[kFixed > 0 ? kFixed : 1];
  Vec3<T> fixed_[kFixed > 0 ? kFixed : 1];
};

template <class FrameStencil, Tangents kTangents, int kSlots, class T>
DEFINITE_INLINE CollisionProjection<FrameStencil, kTangents, kSlots, T>::CollisionProjection(
    const CollisionFrame<T, Stencil, kSlots>& f, const TurnedRows<T, Stencil, kSlots>& turned,
    const T& psi1, const T& psi2) {
  // Below these a number is replaced by them: the Hessian changes by far less than a rounding
  // error, even of what is left of it, and no pole has weight zero or meets another one.
  constexpr double kLeastBlock = 1e-30, kLeastCurvature = 1e-34, kLeastCosine = 1e-17;
  constexpr double kApart = 0x1p-50;

  w_ = f.w;
  const auto w = OverVertices<Stencil>(f.w);
  const T width2 = Dot(w, w), inverse_width = T(1.0) / Sqrt(width2);
  const T width = width2 * inverse_width;
  // The larger of the entries, as a power of two.
  const T slope0 = psi1 * turned.sigma[0];
  const T inverse_unit =
      InversePowerOfTwo(Max(Max(Abs(slope0 * width), Abs(slope0 * (f.l * turned.sigma[0]))),
                            Max(psi2 * width2, T(0x1p-1000))));
  unit_ = T(0.5) * InversePowerOfTwo(inverse_unit);
  h_.curvature = Max(psi2 * inverse_unit, T(kLeastCurvature));
  auto& d = h_.equation.pole;
  T root[kSlots], larger[kSlots];
  trace_ = h_.curvature * width2;
#pragma GCC unroll 2
  for (int k = 0; k < kSlots; ++k) {
    h_.s[k] = Dot(w_, WithEdges<Stencil>(turned.v[k]));
    h_.s[k] = Select(Abs(h_.s[k]) < T(kLeastCosine), T(kLeastCosine), h_.s[k]);
    const T slope = (psi1 * turned.sigma[k]) * inverse_unit;
    h_.a[k] = -slope * (f.l * turned.sigma[k]);
    h_.b[k] = -slope * width;
    h_.b[k] = Select(Abs(h_.b[k]) < T(kLeastBlock), T(kLeastBlock), h_.b[k]);
    h_.b2[k] = h_.b[k] * h_.b[k];
    trace_ = trace_ + h_.a[k];
    const T half = T(0.5) * h_.a[k];
    root[k] = Sqrt(MulAdd(half, half, h_.b2[k]));
    larger[k] = Abs(half) + root[k];
    v_[k] = turned.v[k];
    u_[k] = inverse_width * turned.t[k];
  }
#pragma GCC unroll 2
  for (int k = 0; k < kSlots; ++k) {
    const T inverse = T(1.0) / (larger[k] * root[k]);
    const T smaller = h_.b2[k] * (root[k] * inverse);
    const auto down = h_.a[k] < T(0.0);
    const T plus = Select(down, smaller, larger[k]), minus = Select(down, larger[k], smaller);
    // Poles ascend from the first slot's negative one, for its sigma is the larger.
    d[k] = -minus;
    d[kPoles - 1 - k] = plus;
    const T weight = (T(0.5) * h_.curvature) * (h_.s[k] * h_.s[k]) * (larger[k] * inverse);
    h_.equation.weight[k] = weight * minus;
    h_.equation.weight[kPoles - 1 - k] = weight * plus;
  }
  h_.rest2 = RestOfRow<Stencil, !kByRegion>(f.w, turned.v, h_.s);
  d[kSlots] = T(0.0);
  h_.equation.weight[kSlots] = h_.curvature * h_.rest2;
  if constexpr (kSlots == 2) {
    d[1] = Max(d[1], d[0] - T(kApart) * d[0]);
    d[3] = Min(d[3], d[4] - T(kApart) * d[4]);
  }
  h_.Polynomial(polynomial_);
#pragma GCC unroll 8
  for (int i = 0; i < kPoles; ++i) low_polynomial_[i] = LowOf(polynomial_[i]);
#pragma GCC unroll 2
  for (int k = 0; k < kSlots; ++k) low_root_[k] = LowOf(T(0.5) * (d[k] + d[k + 1]));

  n_ = f.n;
#pragma GCC unroll 2
  for (int i = 0; i < kFixed; ++i) {
    const int k = 2 - kFixed + i;
    const T lambda = psi1 / f.l;
    fixed_weight_[i] = Max(T(0.0), lambda);
    if constexpr (kByRegion) {
      fixed_weight_[i] = Select(f.fixed[k], fixed_weight_[i], T(0.0));
      fixed_[i] = turned.t[k];
    } else {
      fixed_[i] = f.t[k];
    }
  }
}

template <class FrameStencil, Tangents kTangents, int kSlots, class T>
template <int K>
DEFINITE_INLINE void CollisionProjection<FrameStencil, kTangents, kSlots, T>::Add(
    const ReducedPairs<T, kSlots, K>& pairs, const T& sign,
    FramedSum<T, Stencil, true>& sum) const {
#pragma GCC unroll 3
  for (int i = 0; i < K; ++i) {
    // The rest is w less its parts along v.
    Vec3<T> t = pairs.along_n[i][kSlots] * n_;
    Vec<T, Stencil::kEdges> r;
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      const T along = pairs.along_n[i][k] - pairs.along_n[i][kSlots] * h_.s[k];
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) t[j] = MulAdd(pairs.along_u[i][k], u_[k][j], t[j]);
#pragma GCC unroll 2
      for (int e = 0; e < kLast; ++e) {
        r[e] = k == 0 ? along * v_[k][e] : MulAdd(along, v_[k][e], r[e]);
      }
    }
    AddMode((sign * unit_) * pairs.weight[i], t, r, sum);
  }
}

template <class FrameStencil, Tangents kTangents, int kSlots, class T>
DEFINITE_INLINE auto CollisionProjection<FrameStencil, kTangents, kSlots, T>::Result() const
    -> FramedSum<T, Stencil, true> {
  // Where the negative eigenvalues weigh more than so many times the positive ones, these are
  // computed by themselves.
  constexpr double kDeep = 8;
  FramedSum<T, Stencil, true> sum;
  sum.w = w_;
  sum.n = n_;
  FramedSum<T, Stencil, true> deep = sum;
  // The Hessian.
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = i; j < 3; ++j) {
      sum.s[i][j] = (unit_ * h_.curvature * n_[i]) * n_[j];
      deep.s[i][j] = T(0.0);
    }
  }
#pragma GCC unroll 2
  for (int e = 0; e < kLast; ++e) {
    sum.a[e] = deep.a[e] = Vec3<T>{T(0.0), T(0.0), T(0.0)};
#pragma GCC unroll 2
    for (int g = e; g < kLast; ++g) sum.c[e][g] = deep.c[e][g] = T(0.0);
#pragma GCC unroll 2
    for (int k = 0; k < kSlots; ++k) {
      const T of_b = (unit_ * h_.b[k]) * v_[k][e], of_a = (unit_ * h_.a[k]) * v_[k][e];
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) sum.a[e][j] = MulAdd(of_b, u_[k][j], sum.a[e][j]);
#pragma GCC unroll 2
      for (int g = e; g < kLast; ++g) sum.c[e][g] = MulAdd(of_a, v_[k][g], sum.c[e][g]);
    }
  }
  const auto negative = PairsOf(h_, h_.equation.template Roots<0>(root_));
  Add(negative, T(-1.0), sum);

  T dropped = -negative.value[0];
  if constexpr (kSlots == 2) dropped = dropped - negative.value[1];
  const auto is_deep = dropped > T(kDeep) * (trace_ + dropped);
  if (Any(is_deep)) {
    T near[kSlots + 1];  // the middles
#pragma GCC unroll 3
    for (int i = 0; i <= kSlots; ++i) {
      const int k = kSlots + i;
      near[i] = T(0.5) * (h_.equation.pole[k] +
                          (k + 1 < kPoles ? h_.equation.pole[k + 1] : h_.equation.Bound()));
    }
    Add(PairsOf(h_, h_.equation.template Roots<kSlots>(near)), T(1.0), deep);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
      for (int j = i; j < 3; ++j) sum.s[i][j] = Select(is_deep, deep.s[i][j], sum.s[i][j]);
    }
#pragma GCC unroll 2
    for (int e = 0; e < kLast; ++e) {
      sum.a[e] = SelectAll(is_deep, deep.a[e], sum.a[e]);
#pragma GCC unroll 2
      for (int g = e; g < kLast; ++g) sum.c[e][g] = Select(is_deep, deep.c[e][g], sum.c[e][g]);
    }
  }
#pragma GCC unroll 2
  for (int i = 0; i < kFixed; ++i) AddMode(fixed_weight_[i], fixed_[i], sum);
  Mirror(sum);
  return sum;
}

// In one go.
template <class Projection>
DEFINITE_INLINE auto Refined(Projection projection) {
  for (int step = 0; step < Projection::kRefinements; ++step) projection.Refine(step);
  return projection.Result();
}

}  // namespace definite
