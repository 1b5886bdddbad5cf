#pragma once

// A double that counts what a kernel does to it: the operations behind the floor of a kernel
// (docs/protocol.md, section 3).

#include <cmath>

#include "kernels/kernel.hpp"

namespace definite {

struct Counting {
  double value;

  Counting() = default;
  explicit Counting(double v) : value(v) {}

  static inline thread_local Operations done;
};

inline Counting operator+(Counting a, Counting b) {
  ++Counting::done.additions;
  return Counting(a.value + b.value);
}
inline Counting operator-(Counting a, Counting b) {
  ++Counting::done.additions;
  return Counting(a.value - b.value);
}
inline Counting operator*(Counting a, Counting b) {
  ++Counting::done.multiplications;
  return Counting(a.value * b.value);
}
inline Counting operator/(Counting a, Counting b) {
  ++Counting::done.divisions;
  return Counting(a.value / b.value);
}
inline Counting operator-(Counting a) { return Counting(-a.value); }
inline bool operator<(Counting a, Counting b) { return a.value < b.value; }
inline bool operator<=(Counting a, Counting b) { return a.value <= b.value; }
inline bool operator>(Counting a, Counting b) { return a.value > b.value; }
inline bool operator>=(Counting a, Counting b) { return a.value >= b.value; }
inline Counting MulAdd(Counting a, Counting b, Counting c) {
  ++Counting::done.fused;
  return Counting(std::fma(a.value, b.value, c.value));
}
inline Counting Sqrt(Counting a) {
  ++Counting::done.roots;
  return Counting(std::sqrt(a.value));
}
inline Counting log(Counting a) {
  ++Counting::done.logs;
  return Counting(std::log(a.value));
}
inline Counting log1p(Counting a) {
  ++Counting::done.logs;
  return Counting(std::log1p(a.value));
}
inline Counting Abs(Counting a) { return Counting(std::fabs(a.value)); }
inline Counting InversePowerOfTwo(Counting m) { return Counting(InversePowerOfTwo(m.value)); }

}  // namespace definite
