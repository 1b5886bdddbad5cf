#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "reference/energy.hpp"

namespace definite::reference {

// A deformation gradient, row by row, for any scalar.
template <class S, int D>
struct Gradient {
  static constexpr int kD = D;
  std::array<S, static_cast<size_t>(D* D)> entries;

  S& operator()(int i, int j) { return entries.data()[i * D + j]; }
  const S& operator()(int i, int j) const { return entries.data()[i * D + j]; }
};

template <class S, int D>
S Determinant(const Gradient<S, D>& f) {
  if constexpr (D == 2)
    return f(0, 0) * f(1, 1) - f(0, 1) * f(1, 0);
  else
    return f(0, 0) * (f(1, 1) * f(2, 2) - f(1, 2) * f(2, 1)) -
           f(0, 1) * (f(1, 0) * f(2, 2) - f(1, 2) * f(2, 0)) +
           f(0, 2) * (f(1, 0) * f(2, 1) - f(1, 1) * f(2, 0));
}

// The derivative of the determinant: det F times F^-T.
template <class S, int D>
Gradient<S, D> Cofactors(const Gradient<S, D>& f) {
  Gradient<S, D> c;
  if constexpr (D == 2) {
    c.entries = {f(1, 1), -f(1, 0), -f(0, 1), f(0, 0)};
  } else {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        c(i, j) = f(i1, j1) * f(i2, j2) - f(i1, j2) * f(i2, j1);
      }
    }
  }
  return c;
}

// F^T F.
template <class S, int D>
Gradient<S, D> RightCauchyGreen(const Gradient<S, D>& f) {
  Gradient<S, D> c;
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) {
      S sum(0);
      for (int k = 0; k < D; ++k) sum = sum + f(k, i) * f(k, j);
      c(i, j) = sum;
    }
  }
  return c;
}

template <class S, int D>
S NormSquared(const Gradient<S, D>& f) {
  S sum(0);
  for (const S& entry : f.entries) sum = sum + entry * entry;
  return sum;
}

template <class S, int D>
S Trace(const Gradient<S, D>& f) {
  S sum(0);
  for (int i = 0; i < D; ++i) sum = sum + f(i, i);
  return sum;
}

// The sum of the stretches, the last with the sign of det F: the largest tr(R^T F) over rotations.
// In space the largest root of x^4 - 2 |F|^2 x^2 - 8 det F x + 2 |C|^2 - |F|^4, C = F^T F (the
// characteristic polynomial of Horn's 4x4 matrix for the closest rotation; Lin et al. 2022): by
// Newton's method from above, and two steps more with derivatives.
template <class S, int D>
S SumOfStretches(const Gradient<S, D>& f) {
  using std::sqrt;
  if constexpr (D == 2) {
    const S even = f(0, 0) + f(1, 1), odd = f(1, 0) - f(0, 1);
    return sqrt(even * even + odd * odd);
  } else {
    const S square = NormSquared(f), determinant = Determinant(f);
    const S constant = S(2) * NormSquared(RightCauchyGreen(f)) - square * square;
    const auto step = [](const auto& x, const auto& a, const auto& b, const auto& c) {
      return (x * x * x * x - 2 * a * x * x - 8 * b * x + c) / (4 * x * x * x - 4 * a * x - 8 * b);
    };
    auto root = sqrt(3 * ValueOf(square));
    for (int i = 0; i < 300; ++i) {
      const auto less = root - step(root, ValueOf(square), ValueOf(determinant), ValueOf(constant));
      if (!(less < root)) break;
      root = less;
    }
    S sum(root);
    for (int i = 0; i < 2; ++i) sum = sum - step(sum, square, determinant, constant);
    return sum;
  }
}

// The rotation closest to F.
template <class S, int D>
Gradient<S, D> ClosestRotation(const Gradient<S, D>& f) {
  const S x = SumOfStretches(f);
  const Gradient<S, D> cofactors = Cofactors(f);
  Gradient<S, D> r;
  if constexpr (D == 2) {
    for (int i = 0; i < 4; ++i)
      r.entries.data()[i] = (f.entries.data()[i] + cofactors.entries.data()[i]) / x;
  } else {
    // The derivative of the root.
    const Gradient<S, D> c = RightCauchyGreen(f);
    const S square = NormSquared(f), over = x * x * x - square * x - 2 * Determinant(f);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        S fc(0);
        for (int k = 0; k < 3; ++k) fc = fc + f(i, k) * c(k, j);
        r(i, j) = ((x * x + square) * f(i, j) + 2 * x * cofactors(i, j) - 2 * fc) / over;
      }
    }
  }
  return r;
}

// How far F is from where psi stops to be smooth, in units of F: about the smallest change of F
// that leads there. Sharp is what must exceed 1e-8 for psi to be defined.
struct Everywhere {
  template <class T, int D>
  static T Sharp(const Gradient<T, D>&) {
    return T(1);
  }
  template <class T, int D>
  static T Margin(const Gradient<T, D>& f) {
    using std::sqrt;
    return std::max(T(1), T(sqrt(NormSquared(f))));
  }
};
// det F > 0: 1/(|F| |F^-1|).
struct NotInverted {
  template <class T, int D>
  static T Sharp(const Gradient<T, D>& f) {
    using std::sqrt;
    return Determinant(f) / sqrt(NormSquared(f)) / sqrt(NormSquared(Cofactors(f)));
  }
  template <class T, int D>
  static T Margin(const Gradient<T, D>& f) {
    using std::sqrt;
    return Sharp(f) * sqrt(NormSquared(f));
  }
};
// A closest rotation: (s1 + s2)(s2 + s3)(s3 + s1) of (s1 + s2 + s3)^3; in the plane s1 + s2 of |F|.
struct WithRotation {
  template <class T, int D>
  static T Sharp(const Gradient<T, D>& f) {
    using std::sqrt;
    const T x = SumOfStretches(f), square = NormSquared(f);
    if constexpr (D == 2) return x / sqrt(square);
    // s1 s2 + s1 s3 + s2 s3 = (x^2 - |F|^2)/2, and the product of the sums is x times it less det
    // F.
    else
      return ((x * x - square) / 2 * x - Determinant(f)) / (x * x * x);
  }
  template <class T, int D>
  static T Margin(const Gradient<T, D>& f) {
    using std::sqrt;
    return Sharp(f) * sqrt(NormSquared(f));
  }
};

struct Triangle {
  static std::string Name() { return "distortion/triangle"; }
  static constexpr int kD = 2;
};
struct Tetrahedron {
  static std::string Name() { return "distortion/tetrahedron"; }
  static constexpr int kD = 3;
};

// The energy psi(F) of a simplex, F = (x1 - x0 | x2 - x0 ...) R; p = (R row by row, psi's own). The
// frame: F, column by column. Domain: |F_ij| < 2^100, and where psi is defined. Always active.
template <class Simplex, class Psi>
struct Distortion {
  static constexpr int kD = Simplex::kD;
  static constexpr int kDofs = kD * (kD + 1);
  static constexpr int kFrameDofs = kD * kD;
  static constexpr int kParams = kFrameDofs + Psi::kParams;
  using Domain = typename Psi::Domain;

  static std::string Name() { return Simplex::Name() + "/" + Psi::Name(); }

  template <class S, class T>
  static Gradient<S, kD> GradientOf(const S* x, const T* p) {
    Gradient<S, kD> f;
    for (int i = 0; i < kD; ++i) {
      for (int j = 0; j < kD; ++j) {
        S sum(0);
        for (int k = 0; k < kD; ++k) sum = sum + (x[(k + 1) * kD + i] - x[i]) * S(p[k * kD + j]);
        f(i, j) = sum;
      }
    }
    return f;
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return Psi::Value(GradientOf(x, p), p + kFrameDofs);
  }
  // psi is half of their squares, summed.
  template <class S, class T>
  requires requires(const Gradient<S, kD>& f, const T* p) { Psi::Residuals(f, p); }
  static auto Residuals(const S* x, const T* p) {
    return Psi::Residuals(GradientOf(x, p), p + kFrameDofs);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T*, const T* p) {
    Gradient<S, kD> f;
    for (int i = 0; i < kD; ++i) {
      for (int j = 0; j < kD; ++j) f(i, j) = c[j * kD + i];
    }
    return Psi::Value(f, p + kFrameDofs);
  }
  template <class S, class T>
  static std::array<S, static_cast<size_t>(kFrameDofs)> FrameAt(const S* x, const T*, const T* p) {
    const Gradient<S, kD> f = GradientOf(x, p);
    std::array<S, static_cast<size_t>(kFrameDofs)> c;
    for (int i = 0; i < kD; ++i) {
      for (int j = 0; j < kD; ++j) c.data()[j * kD + i] = f(i, j);
    }
    return c;
  }
  template <class T>
  static bool InDomain(const T* x, const T* p) {
    using std::abs;
    const Gradient<T, kD> f = GradientOf(x, p);
    const bool any = std::any_of(f.entries.begin(), f.entries.end(),
                                 [](const T& entry) { return abs(entry) >= T(0x1p100); });
    return !any && Domain::Sharp(f) > T(1e-8);
  }
  template <class T>
  static bool Active(const T*, const T*) {
    return true;
  }
  // Rounding moves F by a part of |edges| |R|.
  template <class T>
  static double Conditioning(const T* x, const T* p) {
    using std::sqrt;
    T edges(0), rest(0);
    for (int i = kD; i < kDofs; ++i) edges += (x[i] - x[i % kD]) * (x[i] - x[i % kD]);
    for (int i = 0; i < kFrameDofs; ++i) rest += p[i] * p[i];
    const T moved = sqrt(edges) * sqrt(rest);
    const T margin = Domain::Margin(GradientOf(x, p));
    return moved > margin ? static_cast<double>(margin / moved) : 1;
  }
};

}  // namespace definite::reference
