#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/energy.hpp"
#include "reference/vec3.hpp"

namespace definite::reference {

// Bending of a strand of three vertices: psi = mu/2 (omega - omega0)^2, omega the angle by which
// the strand turns at the middle one, x1 (Shi et al. 2023, Lifted Curls, supplement, section 1;
// their theta is pi - omega). p = (mu, omega0), omega0 in radians. Domain: a component of each edge
// exceeds 2^-450 in any unit, and the sine of omega 1e-8. The frame: both edges in units of their
// lengths, which are frozen.
struct StrandBend {
  static std::string Name() { return "strand/bend/quadratic"; }
  static constexpr int kDofs = 9;
  static constexpr int kParams = 2;
  static constexpr int kFrameDofs = 6;

  template <class S, class T>
  static S Length(const S* x, const T*) {
    return TurningAngle(Block(x, 0) - Block(x, 1), Block(x, 2) - Block(x, 1));
  }
  template <class S, class T>
  static S Penalty(const S& omega, const T* p) {
    return p[0] * (omega - p[1]) * (omega - p[1]) / T(2);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return Penalty(Length(x, p), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T*, const T* p) {
    return Penalty(TurningAngle(Block(c, 0), Block(c, 1)), p);
  }
  template <class S, class T>
  static std::array<S, 6> FrameAt(const S* x, const T* at, const T*) {
    const T l0 = Norm(Block(at, 0) - Block(at, 1)), l1 = Norm(Block(at, 2) - Block(at, 1));
    const Vec3<S> e0 = Block(x, 0) - Block(x, 1), e1 = Block(x, 2) - Block(x, 1);
    return {e0.x / l0, e0.y / l0, e0.z / l0, e1.x / l1, e1.y / l1, e1.z / l1};
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    const T least = T(0x1p-450);
    return Reach(Block(x, 0) - Block(x, 1)) > least && Reach(Block(x, 2) - Block(x, 1)) > least &&
           Sine(x) > T(1e-8);
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
  template <class T>
  static T Reach(const Vec3<T>& e) {
    using std::abs;
    return std::max({T(abs(e.x)), T(abs(e.y)), T(abs(e.z))});
  }
  template <class S>
  static S TurningAngle(const Vec3<S>& e0, const Vec3<S>& e1) {
    using std::atan2;
    return atan2(Norm(Cross(e0, e1)), -Dot(e0, e1));
  }
  template <class T>
  static T Sine(const T* x) {
    const Vec3<T> e0 = Block(x, 0) - Block(x, 1), e1 = Block(x, 2) - Block(x, 1);
    return Norm(Cross(e0, e1)) / Norm(e0) / Norm(e1);
  }
};

DEFINITE_REFERENCE_ENERGY(StrandBend);

}  // namespace definite::reference
