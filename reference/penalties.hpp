#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "reference/dual.hpp"

namespace definite::reference {

// A penalty psi(s) of a signed or unsigned length s, plain, for any scalar S; p = (k, eps, ...),
// `own` holds the penalty's own parameters. Value returns zero only where s >= eps is known to
// hold, so that a NaN stays one. Margin: what s must change by, in the domain, to change psi'' by
// about psi'' itself.

// Shi & Kim 2023, Eq. 21.
struct Quadratic {
  static std::string Name() { return "quadratic"; }
  static constexpr int kParams = 0;

  template <class S, class T>
  static S Value(const S& s, const T* p, const T*) {
    if (s >= p[1]) return S(T(0));
    return p[0] * (s - p[1]) * (s - p[1]);
  }
  template <class T>
  static bool InDomain(const T&, const T*, const T*) {
    return true;
  }
  template <class T>
  static T Margin(const T&, const T*, const T*) {
    return std::numeric_limits<T>::infinity();
  }
};

// Shi & Kim 2023, Eq. 26; own = (delta), an area. Domain: delta >= 0.
struct Cubic {
  static std::string Name() { return "cubic"; }
  static constexpr int kParams = 1;

  template <class S, class T>
  static S Value(const S& s, const T* p, const T* own) {
    using std::sqrt;
    if (s >= p[1]) return S(T(0));
    const S square = (s - p[1]) * (s - p[1]);
    return p[0] * square * sqrt(square + own[0]);
  }
  template <class T>
  static bool InDomain(const T&, const T*, const T* own) {
    return own[0] >= 0;
  }
  template <class T>
  static T Margin(const T& s, const T* p, const T* own) {
    using std::sqrt;
    return sqrt((s - p[1]) * (s - p[1]) + own[0]);
  }
};

// Shi & Kim 2023, Eq. 30. Domain: s > 0, and s >= 1e-150 eps, as psi'' is k (eps/s)^2.
struct LogBarrier {
  static std::string Name() { return "log_barrier"; }
  static constexpr int kParams = 0;

  template <class S, class T>
  static S Value(const S& s, const T* p, const T*) {
    using std::log;
    if (s >= p[1]) return S(T(0));
    return -p[0] * (s - p[1]) * (s - p[1]) * log(s / p[1]);
  }
  template <class T>
  static bool InDomain(const T& s, const T* p, const T*) {
    return s > 0 && s >= T(1e-150) * p[1];
  }
  template <class T>
  static T Margin(const T& s, const T* p, const T*) {
    return s < p[1] ? std::min(s, T(p[1] - s)) : std::numeric_limits<T>::infinity();
  }
};

// The energy psi(x) = P(L(x)), active where L < eps = p[1]. p holds L's parameters, then P's own.
template <class L, class P>
struct PenaltyOf : L {
  static std::string Name() { return L::Name() + "/" + P::Name(); }
  static constexpr int kParams = L::kParams + P::kParams;

  template <class S, class T>
  static S Penalty(const S& s, const T* p) {
    return P::Value(s, p, p + L::kParams);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return Penalty(L::Length(x, p), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T* at, const T* p) {
    return Penalty(L::FrameLength(c, at, p), p);
  }
  // psi' times the part of the length that is a minimum over the weights.
  template <class S, class T>
  requires requires(const S* c, const T* p) { L::RemainderLength(c, p, p); }
  static S RemainderValue(const S* c, const T* at, const T* p) {
    const T l = L::Length(at, p);
    return Penalty(Variables<1>(&l)[0], p).gradient[0] * L::RemainderLength(c, at, p);
  }
  // Not even float128 tells a length of 1e-32 edges from 0.
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    using std::abs;
    if (!L::InDomain(x, p)) return false;
    T longest = T(0);
    for (int i = 3; i < L::kDofs; ++i) longest = std::max(longest, T(abs(x[i] - x[i % 3])));
    const T s = L::Length(x, p);
    return P::InDomain(abs(s) <= T(1e-32) * longest ? T(0) : s, p, p + L::kParams);
  }
  template <class T>
  static bool Active(const T* x, const T* p) {
    return L::Length(x, p) < p[1];
  }
  template <class T>
  static double Conditioning(const T* x, const T* p) {
    return L::Conditioning(x, p, P::Margin(L::Length(x, p), p, p + L::kParams));
  }
};

}  // namespace definite::reference
