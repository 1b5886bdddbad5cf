#pragma once

// Some eigenvalues of a diagonal matrix plus a positive one of rank one, diag(d) + z z^T:
// the roots of the secular equation 1 + sum_i z_i^2 / (d_i - mu) = 0, one to the right of each pole
// d_i.
//
// Source: docs/derivations.md, section 2; after Gragg's iteration (Borges & Gragg 1993).
// Differs: a root is sought as its distance from the nearer pole. The model of a step has this pole
// and, on the root's other side, one as far away as the nearest of the other poles, which may be
// the far end of the bracket itself. That end always would cancel where a pole is just behind the
// near one.

#include <utility>

#include "kernels/core/precision.hpp"
#include "kernels/core/vec.hpp"

namespace definite {

template <class T, int N>
struct SecularRoot {
  T value;
  T to_pole[N];  // d_i - value, of small relative error however close the two are
};
template <class T, int N, int K>
struct SecularRoots {
  SecularRoot<T, N> root[K];
};

// Poles ascend, by more than a rounding error each; weights are z_i^2 > 0. The roots are those
// right of poles N - K to N - 1. Where two poles meet, the vectors z_i / (d_i - mu) of their roots
// span the right plane but need not be orthogonal.
template <class T, int N>
struct SecularEquation {
  T pole[N], weight[N];

  // Those right of poles kFirst to kFirst + K - 1, each sought from a number near it; a NaN, or one
  // on the wrong side of a pole, costs time and nothing else.
  template <int kFirst, int K>
  DEFINITE_INLINE SecularRoots<T, N, K> Roots(const T (&near)[K]) const {
    return Roots<kFirst>(near, std::make_integer_sequence<int, K>());
  }

  // What no root exceeds.
  DEFINITE_INLINE T Bound() const;

 private:
  static constexpr double kLeastPart = 1e-12;  // of the bracket, between a start and a pole

  // A root between pole k and the next one, or behind the last.
  struct Bracket {
    T direction;  // from the pole that is the origin: 1 if that is on the left, -1 on the right
    T offset;     // from the origin in that direction, > 0
    T moved;      // by the last step
  };

  template <int kFirst, int K, int... m>
  DEFINITE_INLINE SecularRoots<T, N, K> Roots(const T (&near)[K],
                                              std::integer_sequence<int, m...>) const;
  template <int k>
  DEFINITE_INLINE Bracket From(const T& near) const;
  template <int k>
  DEFINITE_INLINE T Origin(const Bracket& b) const;
  template <int k>
  DEFINITE_INLINE void ChooseOrigin(Bracket& b) const;
  template <int k>
  DEFINITE_INLINE void Step(Bracket& b) const;
  template <int k>
  DEFINITE_INLINE MaskOf<T> IsUnsettled(const Bracket& b) const;
  template <int k>
  DEFINITE_INLINE SecularRoot<T, N> RootOf(const Bracket& b) const;
  static DEFINITE_INLINE void Replace(const MaskOf<T>& where, const Bracket& by, Bracket& b) {
    b.direction = Select(where, by.direction, b.direction);
    b.offset = Select(where, by.offset, b.offset);
    b.moved = Select(where, by.moved, b.moved);
  }
};

template <class T, int N>
template <int kFirst, int K, int... m>
DEFINITE_INLINE SecularRoots<T, N, K> SecularEquation<T, N>::Roots(
    const T (&near)[K], std::integer_sequence<int, m...>) const {
  // A start at the wrong end of its bracket doubles its distance from there at each step: 40 from
  // kLeastPart, and a few to settle. No rounding can make it endless.
  constexpr int kMostSteps = 60;
  // All roots side by side: K short chains of operations instead of a long one. Each is one copy of
  // Step, which is most of what the compiler has to read.
  Bracket b[K] = {From<kFirst + m>(near[m])...};
  for (int step = 0; step < kMostSteps; ++step) {
    const auto unsettled = (IsUnsettled<kFirst + m>(b[m]) | ...);
    if (!Any(unsettled)) break;
    // A lane takes the steps that it would take alone.
    Bracket next[K] = {b[m]...};
    (ChooseOrigin<kFirst + m>(next[m]), ...);
    (Step<kFirst + m>(next[m]), ...);
    (Replace(unsettled, next[m], b[m]), ...);
  }
  return {{RootOf<kFirst + m>(b[m])...}};
}

// A start that counts as moved, so that all take a first step.
template <class T, int N>
template <int k>
DEFINITE_INLINE auto SecularEquation<T, N>::From(const T& near) const -> Bracket {
  const T width = k + 1 < N ? pole[k + 1 < N ? k + 1 : k] - pole[k] : Bound() - pole[k];
  // In this order a NaN becomes the lower bound.
  const T offset = Min(Max(near - pole[k], T(kLeastPart) * width), T(1.0 - kLeastPart) * width);
  return {T(1.0), offset, offset};
}

template <class T, int N>
DEFINITE_INLINE T SecularEquation<T, N>::Bound() const {
  T sum = pole[N - 1];
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) sum = sum + weight[i];
  return sum;
}

template <class T, int N>
template <int k>
DEFINITE_INLINE T SecularEquation<T, N>::Origin(const Bracket& b) const {
  if constexpr (k + 1 < N) {
    return Select(b.direction < T(0.0), pole[k + 1], pole[k]);
  } else {
    return pole[k];
  }
}

// The nearer pole.
template <class T, int N>
template <int k>
DEFINITE_INLINE void SecularEquation<T, N>::ChooseOrigin(Bracket& b) const {
  if constexpr (k + 1 < N) {
    const T width = pole[k + 1] - pole[k];
    // A root that rounds onto the other pole is put a little beside it.
    const T from_other = Max(width - b.offset, T(kLeastPart) * width);
    const auto swap = from_other < b.offset;
    b.direction = Select(swap, -b.direction, b.direction);
    b.offset = Select(swap, from_other, b.offset);
  }
}

// In the direction of the bracket the equation is direction + sum_i z_i^2 / (E_i - x) = 0. The sum
// over all poles but the origin is replaced by a constant, a term of the origin and one of the
// model's other pole, with the same value and first two derivatives.
template <class T, int N>
template <int k>
DEFINITE_INLINE void SecularEquation<T, N>::Step(Bracket& b) const {
  constexpr int kOthers = N - 1;
  const T origin = Origin<k>(b);
  T from_origin[kOthers], others_weight[kOthers], near_weight = weight[k];
#pragma GCC unroll 8
  for (int i = 0; i < kOthers; ++i) {
    const int other = i < k ? i : i + 1;
    from_origin[i] = pole[other] - origin;
    others_weight[i] = weight[other];
  }
  if constexpr (k + 1 < N) {
    const auto on_right = b.direction < T(0.0);
    from_origin[k] = Select(on_right, pole[k] - origin, from_origin[k]);
    others_weight[k] = Select(on_right, weight[k], weight[k + 1]);
    near_weight = Select(on_right, weight[k + 1], weight[k]);
#pragma GCC unroll 8
    for (int i = 0; i < kOthers; ++i) from_origin[i] = b.direction * from_origin[i];
  }
  // One reciprocal for all.
  T distance[kOthers], product[kOthers], nearest = b.offset;
#pragma GCC unroll 8
  for (int i = 0; i < kOthers; ++i) {
    distance[i] = from_origin[i] - b.offset;
    product[i] = i == 0 ? distance[0] : product[i - 1] * distance[i];
    nearest = i == 0 ? Abs(distance[0]) : Min(nearest, Abs(distance[i]));
  }
  T inverse = T(1.0) / product[kOthers - 1];
  const T far = b.offset + nearest;
  T constant = b.direction, near_sum = T(0.0), far_sum = T(0.0);  // the sums have positive terms
#pragma GCC unroll 8
  for (int i = kOthers - 1; i >= 0; --i) {
    const T reciprocal = i == 0 ? inverse : inverse * product[i - 1];
    inverse = inverse * distance[i];
    const T cubed = ((others_weight[i] * reciprocal) * reciprocal) * reciprocal;
    const T of_far = cubed * from_origin[i], from_far = from_origin[i] - far;
    constant = MulAdd(of_far, from_far, constant);
    far_sum = far_sum + of_far;
    near_sum = MulAdd(cubed, from_far, near_sum);
  }
  // All times `far`, which saves a division.
  const T cube = b.offset * b.offset * b.offset;
  const T near_pole = MulAdd(cube, near_sum, near_weight * far);
  const T far_pole = nearest * nearest * nearest * far_sum;
  // constant x^2 - linear x + last = 0, of which one root lies between the two poles.
  constant = constant * far;
  const T linear = MulAdd(constant, far, near_pole + far_pole);
  const T last = near_pole * far;
  // Where both poles have a root beside them that is the other's, rounding may leave less than 0.
  const T root = Sqrt(Max(MulAdd(linear, linear, T(-4.0) * (last * constant)), T(0.0)));
  const auto positive = linear >= T(0.0);
  const T next = Select(positive, last + last, linear - root) /
                 Select(positive, linear + root, constant + constant);
  b.moved = Abs(next - b.offset);
  b.offset = next;
}

// Another step would move more than a rounding error, or the other pole is much nearer.
template <class T, int N>
template <int k>
DEFINITE_INLINE MaskOf<T> SecularEquation<T, N>::IsUnsettled(const Bracket& b) const {
  const auto moving = b.moved > T(kUnitCubeRoot<T>) * b.offset;
  if constexpr (k + 1 < N) {
    return moving | (b.offset > T(0.75) * (pole[k + 1] - pole[k]));
  } else {
    return moving;
  }
}

template <class T, int N>
template <int k>
DEFINITE_INLINE SecularRoot<T, N> SecularEquation<T, N>::RootOf(const Bracket& b) const {
  const T origin = Origin<k>(b);
  SecularRoot<T, N> root;
  const T offset = b.direction * b.offset;
  root.value = origin + offset;
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) root.to_pole[i] = (pole[i] - origin) - offset;
  return root;
}

}  // namespace definite
