#pragma once

// The functions a kernel may call on its scalar type T, beyond + - * / and comparison. Each exists
// for double, for Lanes and, in the generic form, for any type with the usual free functions found
// by argument-dependent lookup (float128 and the counting type in the tests).

#include <bit>
#include <cmath>
#include <cstdint>

#include "kernels/core/lanes.hpp"

namespace definite {

template <class T>
DEFINITE_INLINE T Select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

DEFINITE_INLINE bool Any(bool condition) { return condition; }

// a b + c, rounded once where the type has a fused multiply-add.
DEFINITE_INLINE double MulAdd(double a, double b, double c) { return std::fma(a, b, c); }
DEFINITE_INLINE float MulAdd(float a, float b, float c) { return std::fma(a, b, c); }
template <class T>
DEFINITE_INLINE T MulAdd(const T& a, const T& b, const T& c) {
  return a * b + c;
}

DEFINITE_INLINE double Sqrt(double a) { return std::sqrt(a); }
DEFINITE_INLINE float Sqrt(float a) { return std::sqrt(a); }
template <class T>
T Sqrt(const T& a) {
  using std::sqrt;
  return sqrt(a);
}

// The root of a small whole number, which the compiler knows.
template <class T>
struct ConstantRoot {
  static DEFINITE_INLINE T Of(int n) { return Sqrt(T(static_cast<double>(n))); }
};
template <class S, int W>
struct ConstantRoot<Lanes<S, W>> {
  static DEFINITE_INLINE Lanes<S, W> Of(int n) { return Lanes<S, W>(std::sqrt(static_cast<S>(n))); }
};

DEFINITE_INLINE double Abs(double a) { return std::fabs(a); }
template <int W>
DEFINITE_INLINE Lanes<double, W> Abs(const Lanes<double, W>& a) {
  constexpr std::int64_t kMagnitude = 0x7fff'ffff'ffff'ffff;
  using Bits = typename LaneMask<double, W>::Native;
  return std::bit_cast<Lanes<double, W>>(std::bit_cast<Bits>(a.lane) & kMagnitude);
}
template <class T>
T Abs(const T& a) {
  using std::abs;
  return abs(a);
}

// The larger and the smaller of two numbers; b where either is NaN.
template <class T>
DEFINITE_INLINE T Max(const T& a, const T& b) {
  return Select(a > b, a, b);
}

template <class T>
DEFINITE_INLINE T Min(const T& a, const T& b) {
  return Select(a < b, a, b);
}

// 2^(1-e) for positive normal m in [2^e, 2^(e+1)), so that m times it lies in [2, 4). The offset
// by one keeps the reciprocal normal over the whole range. Infinity and NaN give 0.
DEFINITE_INLINE double InversePowerOfTwo(double m) {
  constexpr std::int64_t kExponent = 0x7ff0'0000'0000'0000;
  return std::bit_cast<double>(kExponent - (std::bit_cast<std::int64_t>(m) & kExponent));
}
template <int W>
DEFINITE_INLINE Lanes<double, W> InversePowerOfTwo(const Lanes<double, W>& m) {
  constexpr std::int64_t kExponent = 0x7ff0'0000'0000'0000;
  using Bits = typename LaneMask<double, W>::Native;
  return std::bit_cast<Lanes<double, W>>(kExponent - (std::bit_cast<Bits>(m.lane) & kExponent));
}
template <class T>
T InversePowerOfTwo(const T& m) {
  using std::frexp;
  using std::ldexp;
  int e = 0;
  frexp(m, &e);  // m = f 2^e with f in [1/2, 1)
  return ldexp(T(1), 2 - e);
}

}  // namespace definite
