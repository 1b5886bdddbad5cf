#pragma once

// A double that counts what a kernel does to it: the operations behind the floor of a kernel
// (docs/protocol.md, section 3), and which way each Select went.

#include <array>
#include <cmath>
#include <map>
#include <source_location>
#include <tuple>

#include "kernels/kernel.hpp"

namespace definite {

// How often each Select of the source took its first and its second value, by file, line and
// column. With clang 14, which cannot tell a column, none is recorded.
using SelectOutcomes = std::map<std::tuple<const char*, unsigned, unsigned>, std::array<long, 2>>;

struct Counting {
  double value;

  Counting() = default;
  explicit Counting(double v) : value(v) {}

  static inline thread_local Operations done;
  static inline thread_local SelectOutcomes* selects = nullptr;  // nothing is kept while null

#ifdef __cpp_lib_source_location
  static void Record(bool condition, const std::source_location& where) {
    if (!selects) return;
    ++(*selects)[{where.file_name(), where.line(), where.column()}][condition ? 0 : 1];
  }
#endif
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
inline Counting atan2(Counting y, Counting x) {
  ++Counting::done.logs;  // of the same cost, about
  return Counting(std::atan2(y.value, x.value));
}
inline Counting Abs(Counting a) { return Counting(std::fabs(a.value)); }
#ifdef __cpp_lib_source_location
inline Counting Select(bool condition, const Counting& yes, const Counting& no,
                       std::source_location where = std::source_location::current()) {
  Counting::Record(condition, where);
  return condition ? yes : no;
}
// Those that select on behalf of their callers.
template <int N>
Vec<Counting, N> SelectAll(bool condition, const Vec<Counting, N>& yes, const Vec<Counting, N>& no,
                           std::source_location where = std::source_location::current()) {
  Counting::Record(condition, where);
  return condition ? yes : no;
}
inline Counting Max(const Counting& a, const Counting& b,
                    std::source_location where = std::source_location::current()) {
  return Select(a > b, a, b, where);
}
inline Counting Min(const Counting& a, const Counting& b,
                    std::source_location where = std::source_location::current()) {
  return Select(a < b, a, b, where);
}
#endif
inline Counting InversePowerOfTwo(Counting m) { return Counting(InversePowerOfTwo(m.value)); }

}  // namespace definite
