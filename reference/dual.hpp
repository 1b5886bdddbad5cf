#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <concepts>

namespace definite::reference {

// A second-order dual number: a value with its exact gradient and Hessian in N variables. The
// Hessian is packed: its upper triangle, row by row. Comparisons look at the value alone; plain
// scalars mix in as constants.
template <class T, int N>
struct Dual2 {
  T value{};
  T gradient[N] = {};
  T hessian[N * (N + 1) / 2] = {};

  Dual2() = default;
  template <std::convertible_to<T> Constant>
  Dual2(const Constant& c) : value(static_cast<T>(c)) {}

  friend Dual2 operator+(Dual2 a, const Dual2& b) {
    a.value += b.value;
    for (int i = 0; i < N; ++i) a.gradient[i] += b.gradient[i];
    for (int k = 0; k < N * (N + 1) / 2; ++k) a.hessian[k] += b.hessian[k];
    return a;
  }
  friend Dual2 operator-(const Dual2& a) { return Chain(a, -a.value, T(-1), T(0)); }
  friend Dual2 operator-(const Dual2& a, const Dual2& b) { return a + -b; }
  friend Dual2 operator*(const Dual2& a, const Dual2& b) {
    Dual2 c(a.value * b.value);
    for (int i = 0, k = 0; i < N; ++i) {
      c.gradient[i] = a.value * b.gradient[i] + b.value * a.gradient[i];
      for (int j = i; j < N; ++j, ++k)
        c.hessian[k] = a.value * b.hessian[k] + b.value * a.hessian[k] +
                       a.gradient[i] * b.gradient[j] + b.gradient[i] * a.gradient[j];
    }
    return c;
  }
  friend Dual2 operator/(const Dual2& a, const Dual2& b) {
    const T r = 1 / b.value;
    Dual2 c = a * Chain(b, r, -r * r, 2 * r * r * r);
    c.value = a.value / b.value;  // as T rounds it: branches must go the same way in T and here
    return c;
  }
  friend Dual2 sqrt(const Dual2& a) {
    using std::sqrt;
    const T root = sqrt(a.value);
    return Chain(a, root, 1 / (2 * root), -1 / (4 * root * a.value));
  }
  friend Dual2 log(const Dual2& a) {
    using std::log;
    const T r = 1 / a.value;
    return Chain(a, log(a.value), r, -r * r);
  }
  // Differentiates as arctan(y/x) or as pi/2 - arctan(x/y), whichever quotient is at most 1.
  friend Dual2 atan2(const Dual2& y, const Dual2& x) {
    using std::abs, std::atan2;
    const bool flat = abs(y.value) <= abs(x.value);
    const Dual2 t = flat ? y / x : x / y;
    const T slope = (flat ? 1 : -1) / (1 + t.value * t.value);
    return Chain(t, atan2(y.value, x.value), slope, -2 * t.value * slope / (1 + t.value * t.value));
  }
  friend bool operator==(const Dual2& a, const Dual2& b) { return a.value == b.value; }
  friend std::partial_ordering operator<=>(const Dual2& a, const Dual2& b) {
    if (a.value < b.value) return std::partial_ordering::less;
    if (a.value > b.value) return std::partial_ordering::greater;
    return a == b ? std::partial_ordering::equivalent : std::partial_ordering::unordered;
  }

 private:
  // f(a), given f, f' and f'' at a.value.
  friend Dual2 Chain(const Dual2& a, const T& f, const T& f1, const T& f2) {
    Dual2 c(f);
    for (int i = 0, k = 0; i < N; ++i) {
      c.gradient[i] = f1 * a.gradient[i];
      for (int j = i; j < N; ++j, ++k)
        c.hessian[k] = f1 * a.hessian[k] + f2 * (a.gradient[i] * a.gradient[j]);
    }
    return c;
  }
};

// The value alone, of a dual number or of a plain scalar.
template <class T>
T ValueOf(const T& s) {
  return s;
}
template <class T, int N>
T ValueOf(const Dual2<T, N>& s) {
  return s.value;
}

template <int N, class S>
auto Values(const S* x) {
  std::array<decltype(ValueOf(*x)), N> values;
  for (size_t i = 0; i < N; ++i) values[i] = ValueOf(x[i]);
  return values;
}

// The independent variables x[0..N) themselves.
template <int N, class T>
std::array<Dual2<T, N>, N> Variables(const T* x) {
  std::array<Dual2<T, N>, N> variables;
  for (size_t i = 0; i < N; ++i) {
    variables[i].value = x[i];
    variables[i].gradient[i] = T(1);
  }
  return variables;
}

}  // namespace definite::reference
