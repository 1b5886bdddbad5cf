#pragma once

#include <array>
#include <string>

#include "reference/energy.hpp"
#include "reference/vec3.hpp"

namespace definite::reference {

// Stretching of a strand of two vertices: psi = k/2 (|x1 - x0| - length)^2. p = (k, length), length
// that at rest. Domain: the spring has a length. The frame: the edge.
struct StrandStretch {
  static std::string Name() { return "strand/stretch/quadratic"; }
  static constexpr int kDofs = 6;
  static constexpr int kParams = 2;
  static constexpr int kFrameDofs = 3;

  template <class S, class T>
  static S Length(const S* x, const T*) {
    return Norm(Block(x, 1) - Block(x, 0));
  }
  template <class S, class T>
  static S Penalty(const S& length, const T* p) {
    return p[0] * (length - p[1]) * (length - p[1]) / T(2);
  }
  template <class S, class T>
  static S Value(const S* x, const T* p) {
    return Penalty(Length(x, p), p);
  }
  template <class S, class T>
  static S FrameValue(const S* c, const T*, const T* p) {
    return Penalty(Norm(Block(c, 0)), p);
  }
  template <class S, class T>
  static std::array<S, 3> FrameAt(const S* x, const T*, const T*) {
    const Vec3<S> e = Block(x, 1) - Block(x, 0);
    return {e.x, e.y, e.z};
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    return Norm(Block(x, 1) - Block(x, 0)) > 0;
  }
  template <class T>
  static bool Active(const T*, const T*) {
    return true;
  }
  template <class T>
  static double Conditioning(const T*, const T*) {
    return 1;
  }
};

DEFINITE_REFERENCE_ENERGY(StrandStretch);

}  // namespace definite::reference
