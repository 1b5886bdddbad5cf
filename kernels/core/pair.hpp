#pragma once

// Two numbers of a scalar type that go the same way: what an iteration with long chains of roots
// and divisions computes on, so that one batch of lanes hides the latencies of the other.

#include "kernels/core/precision.hpp"
#include "kernels/core/transcendental.hpp"
#include "kernels/core/vec.hpp"

namespace definite {

template <class Mask>
struct PairMask {
  Mask a, b;
};

template <class T>
struct Pair {
  T a, b;

  Pair() = default;
  explicit DEFINITE_INLINE Pair(double value) : a(value), b(value) {}
  DEFINITE_INLINE Pair(const T& of_a, const T& of_b) : a(of_a), b(of_b) {}
};

#define DEFINITE_PAIR_OPERATOR(Result, op)                                 \
  template <class T>                                                       \
  DEFINITE_INLINE Result operator op(const Pair<T>& x, const Pair<T>& y) { \
    return {x.a op y.a, x.b op y.b};                                       \
  }
DEFINITE_PAIR_OPERATOR(Pair<T>, +)
DEFINITE_PAIR_OPERATOR(Pair<T>, -)
DEFINITE_PAIR_OPERATOR(Pair<T>, *)
DEFINITE_PAIR_OPERATOR(Pair<T>, /)
DEFINITE_PAIR_OPERATOR(PairMask<MaskOf<T>>, <)
DEFINITE_PAIR_OPERATOR(PairMask<MaskOf<T>>, <=)
DEFINITE_PAIR_OPERATOR(PairMask<MaskOf<T>>, >)
DEFINITE_PAIR_OPERATOR(PairMask<MaskOf<T>>, >=)
#undef DEFINITE_PAIR_OPERATOR

template <class T>
DEFINITE_INLINE Pair<T> operator-(const Pair<T>& x) {
  return {-x.a, -x.b};
}
template <class Mask>
DEFINITE_INLINE PairMask<Mask> operator|(const PairMask<Mask>& x, const PairMask<Mask>& y) {
  return {x.a | y.a, x.b | y.b};
}
template <class Mask>
DEFINITE_INLINE bool Any(const PairMask<Mask>& mask) {
  return Any(mask.a | mask.b);
}
template <class Mask, class T>
DEFINITE_INLINE Pair<T> Select(const PairMask<Mask>& mask, const Pair<T>& yes, const Pair<T>& no) {
  return {Select(mask.a, yes.a, no.a), Select(mask.b, yes.b, no.b)};
}
template <class T>
DEFINITE_INLINE Pair<T> Max(const Pair<T>& x, const Pair<T>& y) {
  return {Max(x.a, y.a), Max(x.b, y.b)};
}
template <class T>
DEFINITE_INLINE Pair<T> Min(const Pair<T>& x, const Pair<T>& y) {
  return {Min(x.a, y.a), Min(x.b, y.b)};
}
template <class T>
DEFINITE_INLINE Pair<T> MulAdd(const Pair<T>& x, const Pair<T>& y, const Pair<T>& z) {
  return {MulAdd(x.a, y.a, z.a), MulAdd(x.b, y.b, z.b)};
}

#define DEFINITE_PAIR_FUNCTION(Function)               \
  template <class T>                                   \
  DEFINITE_INLINE Pair<T> Function(const Pair<T>& x) { \
    return {Function(x.a), Function(x.b)};             \
  }
DEFINITE_PAIR_FUNCTION(Sqrt)
DEFINITE_PAIR_FUNCTION(Abs)
DEFINITE_PAIR_FUNCTION(InversePowerOfTwo)
DEFINITE_PAIR_FUNCTION(Log)
DEFINITE_PAIR_FUNCTION(Log1p)
#undef DEFINITE_PAIR_FUNCTION

template <class T>
struct ConstantRoot<Pair<T>> {
  static DEFINITE_INLINE Pair<T> Of(int n) {
    return {ConstantRoot<T>::Of(n), ConstantRoot<T>::Of(n)};
  }
};
template <class T>
inline constexpr double kUnitRoundoff<Pair<T>> = kUnitRoundoff<T>;
template <class T>
inline constexpr double kUnitCubeRoot<Pair<T>> = kUnitCubeRoot<T>;

}  // namespace definite
