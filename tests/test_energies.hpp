#pragma once

// An energy of the tests' own, to see that the interface holds it: 6 degrees of freedom in the
// plane, stretches that are coupled, and a Hessian that is PSD in some shapes.

#include <array>

#include "kernels/core/symmetric2.hpp"
#include "kernels/registry.hpp"

namespace definite::testing {

struct Triangle2D {
  static constexpr std::string_view kName = "triangle";
  static constexpr std::array<int, 0> kRelabellings{};  // the rest shape tells the vertices apart
  static constexpr int kDimension = 2;
  static constexpr int kTree[] = {0, 1, 0, 2};
};

// Co-rotational energy |F - R|^2 + k/2 tr(S - I)^2 of a right isosceles triangle at rest (k = 0:
// as rigid as possible), F = (x1 - x0 | x2 - x0). The scaling block 2 I + k 1 1^T couples the
// stretches for k != 0.
struct TriangleArap {
  using Stencil = Triangle2D;
  static std::string Source() { return "Smith, de Goes & Kim 2019, sections 5.1 and F.1"; }
  static constexpr int kDofs = 6, kParams = 2;
  // H is unchanged when lengths and the rest length grow together.
  static constexpr Parameter kParameters[] = {{"k", 1.0, 0, "stiffness of tr S"},
                                              {"rest", 1.0, 1, "rest length of an edge"}};
  static std::string Name() { return "test/triangle_arap"; }

  // c = cos, s = sin of the polar rotation; q = sigma_1 + sigma_2 in units of `rest`.
  template <class T>
  struct Frame {
    T a, b, c, d, cosine, sine, q;
  };
  template <class T>
  static Frame<T> FrameOf(const Vec<T, 6>& x, const T& rest) {
    const T i = T(1.0) / rest;
    Frame<T> f;
    f.a = i * (x[2] - x[0]);
    f.b = i * (x[4] - x[0]);
    f.c = i * (x[3] - x[1]);
    f.d = i * (x[5] - x[1]);
    const T u = f.a + f.d, v = f.c - f.b;
    f.q = Sqrt(MulAdd(u, u, v * v));
    f.cosine = u / f.q;
    f.sine = v / f.q;
    return f;
  }
  // vec of [[a, b], [c, d]] pulled back to the vertices.
  template <class T>
  static Vec<T, 6> Pull(const T& a, const T& b, const T& c, const T& d) {
    return {-(a + b), -(c + d), a, c, b, d};
  }
  template <class T>
  static T Value(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const auto f = FrameOf(x, p[1]);
    const T da = f.a - f.cosine, db = f.b + f.sine, dc = f.c - f.sine, dd = f.d - f.cosine;
    const T trace = f.q - T(2.0);
    return (da * da + db * db + dc * dc + dd * dd + T(0.5) * p[0] * trace * trace) * p[1] * p[1];
  }
  template <class T>
  static Vec<T, 6> Gradient(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const auto f = FrameOf(x, p[1]);
    const T two = T(2.0), trace = p[0] * (f.q - T(2.0));
    return p[1] * Pull(two * (f.a - f.cosine) + trace * f.cosine,
                       two * (f.b + f.sine) - trace * f.sine,
                       two * (f.c - f.sine) + trace * f.sine,
                       two * (f.d - f.cosine) + trace * f.cosine);
  }
  template <class T>
  static Classification<T> Classify(const Vec<T, 6>&, const Vec<T, 2>&) {
    return {T(1.0), T(1.0), T(0.0)};
  }
  template <Set kSet, Part kPart, class T>
    requires(kSet != Set::kPrinted)
  static auto HessianModes(const Vec<T, 6>& x, const Vec<T, 2>& p) {
    const auto f = FrameOf(x, p[1]);
    const T c = f.cosine, s = f.sine, k = p[0];
    Modes<T, 6, 4> m;
    // In the frame R S, with S = I: twist, flip and the two stretches need no SVD, because all but
    // the twist and the trace have the eigenvalue 2.
    m.lambda[0] = T(1.0) + (k * (f.q - T(2.0)) - T(2.0)) / f.q;
    m.v[0] = Pull(-s, -c, c, -s);  // R times the unit twist, norm sqrt 2
    const auto e = SymmetricEigen2(T(2.0) + k, k, T(2.0) + k);
    const Vec<T, 6> d0 = Pull(c, T(0.0), s, T(0.0)), d1 = Pull(T(0.0), -s, T(0.0), c);
    m.lambda[1] = e.first;
    m.v[1] = e.c * d0 + e.s * d1;
    m.lambda[2] = e.second;
    m.v[2] = T(-1.0) * e.s * d0 + e.c * d1;
    m.lambda[3] = T(1.0);
    m.v[3] = Pull(-s, c, c, s);  // R times the unit flip, norm sqrt 2
    if constexpr (kPart == Part::kCurvature) {
      m.lambda[0] = T(0.0);  // the part at constant rotation
    }
    return m;
  }
};

}  // namespace definite::testing
