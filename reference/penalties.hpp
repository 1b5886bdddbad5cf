#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace definite::reference {

// A penalty psi(s) of a signed or unsigned length s, plain, for any scalar S; p = (k, eps, ...).
// Each returns zero only where s >= eps is known to hold, so that a NaN stays one.

// Shi & Kim 2023, Eq. 21.
struct Quadratic {
  static constexpr std::string_view kName = "quadratic";

  template <class S, class T>
  static S Value(const S& s, const T* p) {
    if (s >= p[1]) return S(T(0));
    return p[0] * (s - p[1]) * (s - p[1]);
  }
};

// "a/b", at compile time.
template <const std::string_view& a, const std::string_view& b>
struct JoinedName {
  static constexpr auto kChars = [] {
    std::array<char, a.size() + 1 + b.size()> chars{};
    *std::copy(a.begin(), a.end(), chars.begin()) = '/';
    std::copy(b.begin(), b.end(), chars.begin() + a.size() + 1);
    return chars;
  }();
  static constexpr std::string_view kName{kChars.data(), kChars.size()};
};

// The energy psi(x) = P(L(x)), active where L < eps = p[1].
template <class L, class P>
struct PenaltyOf : L {
  static constexpr std::string_view kName = JoinedName<L::kName, P::kName>::kName;

  template <class S, class T>
  static S Penalty(const S& s, const T* p) {
    return P::Value(s, p);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return P::Value(L::Length(x, p), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T* p) {
    return P::Value(L::FrameLength(c, p), p);
  }
  template <class T>
  static bool Active(const T* x, const T* p) {
    return L::Length(x, p) < p[1];
  }
};

}  // namespace definite::reference
