#pragma once

// Half the digits of a scalar, for what only starts an iteration: float for double.

#include "kernels/core/vec.hpp"

namespace definite {

template <class T>
struct LowPrecision {
  using Type = T;
  static Type Of(const T& value) { return value; }
  static T Back(const Type& value) { return value; }
};
template <>
struct LowPrecision<double> {
  using Type = float;
  static DEFINITE_INLINE float Of(double value) { return static_cast<float>(value); }
  static DEFINITE_INLINE double Back(float value) { return value; }
};
template <int W>
struct LowPrecision<Lanes<double, W>> {
  using Type = Lanes<float, W>;
  static DEFINITE_INLINE Type Of(const Lanes<double, W>& value) {
    return internal::Wrap<Type>(__builtin_convertvector(value.lane, typename Type::Native));
  }
  static DEFINITE_INLINE Lanes<double, W> Back(const Type& value) {
    return internal::Wrap<Lanes<double, W>>(
        __builtin_convertvector(value.lane, typename Lanes<double, W>::Native));
  }
};

template <class T>
DEFINITE_INLINE typename LowPrecision<T>::Type LowOf(const T& value) {
  return LowPrecision<T>::Of(value);
}

}  // namespace definite
