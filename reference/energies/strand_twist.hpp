#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/energy.hpp"
#include "reference/vec3.hpp"

namespace definite::reference {

// Twisting of a strand of four vertices: psi = mu/2 (tau - tau0)^2, tau the angle from the first
// edge to the last about the middle one, the difference within (-pi, pi] (Shi et al. 2023, Lifted
// Curls, supplement, section 2). p = (mu, tau0). Domain: a component of each edge exceeds 2^-450 in
// any unit, and the sines between the middle edge and the others 1e-8. The frame: stretches and
// turns of the parts of the outer edges that are normal to the middle one, how that leans across
// itself, and how the outer edges' feet slide along it.
struct StrandTwist {
  static std::string Name() { return "strand/twist/quadratic"; }
  static constexpr int kDofs = 12;
  static constexpr int kParams = 2;
  static constexpr int kFrameDofs = 8;

  // tau - tau0, the short way round.
  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const auto [e0, e1, e2] = EdgesOf(x);
    using std::atan2;
    const S tau = atan2(Norm(e1) * Dot(e1, Cross(e0, e2)), Dot(Cross(e0, e1), Cross(e2, e1)));
    const T pi = atan2(T(0), T(-1));
    S d = tau - p[1];
    if (d > S(pi)) d = d - 2 * pi;
    if (d <= S(-pi)) d = d + 2 * pi;
    return d;
  }
  template <class S, class T>
  static S Penalty(const S& d, const T* p) {
    return p[0] * d * d / T(2);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return Penalty(Length(x, p), p);
  }
  template <class S, class T>
  static std::array<S, 8> FrameAt(const S* x, const T* at, const T*) {
    const auto [e0, e1, e2] = EdgesOf(x);
    const auto [f0, f1, f2] = EdgesOf(at);
    const T l = Norm(f1), alpha = Dot(f0, f1) / (l * l), beta = Dot(f2, f1) / (l * l);
    const Vec3<T> k = T(1) / l * f1, a = f0 - alpha * f1, b = f2 - beta * f1;
    const T la = Norm(a), lb = Norm(b);
    // The foot of the first edge is held where it is on the middle one, and so is the last one's.
    const Vec3<S> first = Scaled(e0 - S(alpha) * e1, 1 / la),
                  last = Scaled(e2 - S(beta) * e1, 1 / lb);
    const Vec3<S> middle = Scaled(e1, 1 / l);
    const Vec3<T> ua = T(1) / la * a, ub = T(1) / lb * b, pa = Cross(k, ua), pb = Cross(k, ub);
    const auto along = [](const Vec3<T>& u, const Vec3<S>& v) {
      return S(u.x) * v.x + S(u.y) * v.y + S(u.z) * v.z;
    };
    return {along(ua, first),
            along(pa, first),
            along(ub, last),
            along(pb, last),
            along(ua, middle),
            along(pa, middle),
            along(k, first) + along(ua, middle),
            along(k, last) + along(ub, middle)};
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    const auto [e0, e1, e2] = EdgesOf(x);
    const T least = T(0x1p-450);
    return Reach(e0) > least && Reach(e1) > least && Reach(e2) > least && Sine(x) > T(1e-8);
  }
  template <class T>
  static bool Active(const T*, const T*) {
    return true;
  }
  template <class T>
  static double Conditioning(const T* x, const T*) {
    return static_cast<double>(Sine(x));
  }

 private:
  template <class S>
  static std::array<Vec3<S>, 3> EdgesOf(const S* x) {
    return {Block(x, 0) - Block(x, 1), Block(x, 2) - Block(x, 1), Block(x, 3) - Block(x, 2)};
  }
  template <class S, class T>
  static Vec3<S> Scaled(const Vec3<S>& v, const T& factor) {
    return S(factor) * v;
  }
  template <class T>
  static T Reach(const Vec3<T>& e) {
    using std::abs;
    return std::max({T(abs(e.x)), T(abs(e.y)), T(abs(e.z))});
  }
  // The smaller of the two sines.
  template <class T>
  static T Sine(const T* x) {
    const auto [e0, e1, e2] = EdgesOf(x);
    return std::min(T(Norm(Cross(e0, e1)) / Norm(e0) / Norm(e1)),
                    T(Norm(Cross(e2, e1)) / Norm(e2) / Norm(e1)));
  }
};

DEFINITE_REFERENCE_ENERGY(StrandTwist);

}  // namespace definite::reference
