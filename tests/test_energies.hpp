#pragma once

// Two energies from outside the collision family, to see that the interface holds them: 9 and 6
// degrees of freedom, and modes that are coupled. They live in the tests only.

#include <array>

#include "kernels/registry.hpp"

namespace definite::testing {

// Eigenvalues and unit eigenvectors of [[a, b], [b, d]]; (c, s) belongs to `first`.
template <class T>
struct Eigen2 {
  T first, second, c, s;
};
template <class T>
Eigen2<T> SymmetricEigen2(const T& a, const T& b, const T& d) {
  // tan of the Jacobi angle, the smaller root; a diagonal block needs no turn.
  const T h = T(0.5) * (d - a);
  const T root = Sqrt(MulAdd(h, h, b * b));
  const T denominator = Abs(h) + root;
  const T magnitude = b / Select(denominator > T(0.0), denominator, T(1.0));
  const T t = Select(h < T(0.0), -magnitude, magnitude);
  const T c = T(1.0) / Sqrt(MulAdd(t, t, T(1.0)));
  return {a - t * b, d + t * b, c, -(t * c)};
}

struct Corner {
  static constexpr std::string_view kName = "corner";
  static constexpr int kRelabellings[] = {2, 1, 0};
  static constexpr int kDimension = 3;
};

// Strand bending psi = mu (1 - cos(theta - theta0)), theta the angle between the two edges that
// meet at x1: f1 = mu sin(theta - theta0) and f2 = mu cos(theta - theta0) without inverse functions.
// H = D^-1 H_unit D^-1 with D the edge lengths.
struct StrandBend {
  using Stencil = Corner;
  static constexpr std::string_view kSource = "Shi et al. 2023, Lifted Curls supplement, section 1";
  static constexpr int kDofs = 9, kParams = 3;
  static constexpr Parameter kParameters[] = {{"mu", 1.0, 2, "stiffness"},
                                              {"cos_theta0", 0.0, 0, "of the rest angle"},
                                              {"sin_theta0", 1.0, 0, "of the rest angle"}};
  static std::string Name() { return "test/strand_bend"; }

  template <class T>
  struct Frame {
    Vec3<T> t0, t1, n, b0, b1;
    T i0, i1, cosine, sine;  // 1/l0, 1/l1, of theta
  };
  template <class T>
  static Frame<T> FrameOf(const Vec<T, 9>& x) {
    const Vec3<T> e0 = Vertex(x, 0) - Vertex(x, 1), e1 = Vertex(x, 2) - Vertex(x, 1);
    Frame<T> f;
    const T l0 = Sqrt(Dot(e0, e0)), l1 = Sqrt(Dot(e1, e1));
    f.i0 = T(1.0) / l0;
    f.i1 = T(1.0) / l1;
    f.t0 = f.i0 * e0;
    f.t1 = f.i1 * e1;
    const Vec3<T> c = Cross(f.t0, f.t1);
    f.sine = Sqrt(Dot(c, c));
    f.cosine = Dot(f.t0, f.t1);
    f.n = (T(1.0) / f.sine) * c;
    f.b0 = Cross(f.t0, f.n);
    f.b1 = Cross(f.t1, f.n);
    return f;
  }
  // (u / l0, v / l1) pulled back from the two edges to the three vertices.
  template <class T>
  static Vec<T, 9> Pull(const Frame<T>& f, const Vec3<T>& u, const Vec3<T>& v) {
    const Vec3<T> a = f.i0 * u, b = f.i1 * v;
    Vec<T, 9> r;
    for (int i = 0; i < 3; ++i) {
      r[i] = a[i];
      r[3 + i] = -(a[i] + b[i]);
      r[6 + i] = b[i];
    }
    return r;
  }
  template <class T>
  static T Slope(const Frame<T>& f, const Vec<T, 3>& p) {  // f1
    return p[0] * (f.sine * p[1] - f.cosine * p[2]);
  }
  template <class T>
  static T Value(const Vec<T, 9>& x, const Vec<T, 3>& p) {
    const auto f = FrameOf(x);
    const T dc = f.cosine - p[1], ds = f.sine - p[2];
    return T(0.5) * p[0] * (dc * dc + ds * ds);
  }
  template <class T>
  static Vec<T, 9> Gradient(const Vec<T, 9>& x, const Vec<T, 3>& p) {
    const auto f = FrameOf(x);
    return Slope(f, p) * Pull(f, f.b0, T(-1.0) * f.b1);
  }
  template <class T>
  static Classification<T> Classify(const Vec<T, 9>&, const Vec<T, 3>&) {
    return {T(1.0), T(1.0), T(0.0)};
  }
  template <Set kSet, Part kPart, class T>
    requires(kSet == Set::kFrame)
  static auto HessianModes(const Vec<T, 9>& x, const Vec<T, 3>& p) {
    const auto f = FrameOf(x);
    const T half = T(0.5), f1 = Slope(f, p);
    const T f2 = p[0] * (f.cosine * p[1] + f.sine * p[2]);
    const T tan_half = f.sine / (T(1.0) + f.cosine);
    if constexpr (kPart == Part::kCurvature) {
      Modes<T, 9, 1> m;
      m.lambda[0] = f2;
      m.v[0] = Pull(f, f.b0, T(-1.0) * f.b1);
      return m;
    } else {
      // Two coupled blocks on ((t0; t1), (b0; -b1)) and ((t0; -t1), (b0; b1)), and (n; +-n).
      Modes<T, 9, 6> m;
      const Vec3<T> minus_b1 = T(-1.0) * f.b1, minus_t1 = T(-1.0) * f.t1;
      const Vec<T, 9> u0 = Pull(f, f.t0, f.t1), w0 = Pull(f, f.b0, minus_b1);
      const Vec<T, 9> u1 = Pull(f, f.t0, minus_t1), w1 = Pull(f, f.b0, f.b1);
      const auto e = SymmetricEigen2(T(0.0), -f1, f2 + f2);
      const auto g = SymmetricEigen2(T(0.0), -f1, T(0.0));
      m.lambda[0] = half * e.first;
      m.v[0] = e.c * u0 + e.s * w0;
      m.lambda[1] = half * e.second;
      m.v[1] = T(-1.0) * e.s * u0 + e.c * w0;
      m.lambda[2] = half * g.first;
      m.v[2] = g.c * u1 + g.s * w1;
      m.lambda[3] = half * g.second;
      m.v[3] = T(-1.0) * g.s * u1 + g.c * w1;
      m.lambda[4] = T(-1.0) * half * f1 * tan_half;
      m.v[4] = Pull(f, f.n, f.n);
      m.lambda[5] = half * f1 / tan_half;
      m.v[5] = Pull(f, f.n, T(-1.0) * f.n);
      return m;
    }
  }
};

struct Triangle2D {
  static constexpr std::string_view kName = "triangle";
  static constexpr std::array<int, 0> kRelabellings{};  // the rest shape tells the vertices apart
  static constexpr int kDimension = 2;
};

// Co-rotational energy |F - R|^2 + k/2 tr(S - I)^2 of a right isosceles triangle at rest (k = 0:
// as rigid as possible), F = (x1 - x0 | x2 - x0). The scaling block 2 I + k 1 1^T couples the
// stretches for k != 0.
struct TriangleArap {
  using Stencil = Triangle2D;
  static constexpr std::string_view kSource = "Smith, de Goes & Kim 2019, sections 5.1 and F.1";
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
    requires(kSet == Set::kFrame)
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
