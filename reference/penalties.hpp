#pragma once

#include <string>

namespace definite::reference {

// A penalty psi(s) of a signed or unsigned length s, plain, for any scalar S; p = (k, eps, ...).
// Each returns zero only where s >= eps is known to hold, so that a NaN stays one.

// Shi & Kim 2023, Eq. 21.
struct Quadratic {
  static std::string Name() { return "quadratic"; }

  template <class S, class T>
  static S Value(const S& s, const T* p) {
    if (s >= p[1]) return S(T(0));
    return p[0] * (s - p[1]) * (s - p[1]);
  }
};

// The energy psi(x) = P(L(x)), active where L < eps = p[1].
template <class L, class P>
struct PenaltyOf : L {
  static std::string Name() { return L::Name() + "/" + P::Name(); }

  template <class S, class T>
  static S Penalty(const S& s, const T* p) {
    return P::Value(s, p);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return P::Value(L::Length(x, p), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T* at, const T* p) {
    return P::Value(L::FrameLength(c, at, p), p);
  }
  template <class T>
  static bool Active(const T* x, const T* p) {
    return L::Length(x, p) < p[1];
  }
};

}  // namespace definite::reference
