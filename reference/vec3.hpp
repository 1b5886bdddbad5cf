#pragma once

#include <cmath>
#include <type_traits>

namespace definite::reference {

template <class S>
struct Vec3 {
  S x, y, z;
};

template <class S>
Vec3<S> operator+(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class S>
Vec3<S> operator-(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class S>
Vec3<S> operator*(const std::type_identity_t<S>& s, const Vec3<S>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

template <class S>
S Dot(const Vec3<S>& a, const Vec3<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class S>
Vec3<S> Cross(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class S>
S Norm(const Vec3<S>& a) {
  using std::sqrt;
  return sqrt(Dot(a, a));
}

// The i-th of the 3-vectors stacked in x.
template <class S>
Vec3<S> Block(const S* x, int i) {
  return {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
}

}  // namespace definite::reference
