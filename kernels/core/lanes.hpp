#pragma once

// Lanes<S, W>: W configurations side by side, one in each lane of a machine vector. A thin layer
// over the compilers' vector extensions: std::experimental::simd gives wrong comparison masks with
// clang 14.

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace definite {

#if defined(__AVX512F__)
inline constexpr int kVectorBytes = 64;
#elif defined(__AVX__)
inline constexpr int kVectorBytes = 32;
#else
inline constexpr int kVectorBytes = 16;
#endif

// The instruction set the lanes were compiled for: a field of every result.
#if defined(__AVX512F__)
inline constexpr const char* kInstructionSet = "avx512";
#elif defined(__AVX2__) && defined(__FMA__)
inline constexpr const char* kInstructionSet = "avx2+fma";
#elif defined(__AVX__)
inline constexpr const char* kInstructionSet = "avx";
#elif defined(__SSE2__)
inline constexpr const char* kInstructionSet = "sse2";
#else
inline constexpr const char* kInstructionSet = "generic";
#endif

// Doubles in a machine vector. A wider type, split by the compiler, ran 2.5 times slower (g++ 12,
// AVX2): it spills.
inline constexpr int kNativeLanes = kVectorBytes / static_cast<int>(sizeof(double));

#define DEFINITE_INLINE inline __attribute__((always_inline))

template <class S, int W>
struct LaneMask {
  using Integer = std::conditional_t<sizeof(S) == 8, std::int64_t, std::int32_t>;
  typedef Integer Native __attribute__((vector_size(sizeof(S) * W)));
  Native lane;
};

template <class S, int W>
struct Lanes {
  typedef S Native __attribute__((vector_size(sizeof(S) * W)));
  Native lane;

  Lanes() = default;
  explicit DEFINITE_INLINE Lanes(S s) : lane(s - Native{}) {}  // + would turn -0 into 0

  static DEFINITE_INLINE Lanes Load(const S* from) {
    Lanes r;
    __builtin_memcpy(&r.lane, from, sizeof(r.lane));
    return r;
  }
  DEFINITE_INLINE void Store(S* to) const { __builtin_memcpy(to, &lane, sizeof(lane)); }
  // Past the caches; `to` is aligned like a vector.
  DEFINITE_INLINE void Stream(S* to) const {
#if defined(__AVX512F__)
    if constexpr (sizeof(lane) == 64) return _mm512_stream_pd(to, lane);
#elif defined(__AVX__)
    if constexpr (sizeof(lane) == 32) return _mm256_stream_pd(to, lane);
#endif
    Store(to);
  }
};

namespace internal {

// A constructor from the machine vector would clash with the broadcast: g++ 12 takes the two
// parameter types for one.
template <class Vector, class Native>
DEFINITE_INLINE Vector Wrap(Native native) {
  Vector v;
  v.lane = native;
  return v;
}

}  // namespace internal

#define DEFINITE_LANES_OPERATOR(Result, op)                                                  \
  template <class S, int W>                                                                  \
  DEFINITE_INLINE Result<S, W> operator op(const Lanes<S, W>& a, const Lanes<S, W>& b) {     \
    return internal::Wrap<Result<S, W>>(a.lane op b.lane);                                    \
  }
DEFINITE_LANES_OPERATOR(Lanes, +)
DEFINITE_LANES_OPERATOR(Lanes, -)
DEFINITE_LANES_OPERATOR(Lanes, *)
DEFINITE_LANES_OPERATOR(Lanes, /)
DEFINITE_LANES_OPERATOR(LaneMask, <)
DEFINITE_LANES_OPERATOR(LaneMask, <=)
DEFINITE_LANES_OPERATOR(LaneMask, >)
DEFINITE_LANES_OPERATOR(LaneMask, >=)
#undef DEFINITE_LANES_OPERATOR

template <class S, int W>
DEFINITE_INLINE Lanes<S, W> operator-(const Lanes<S, W>& a) {
  return internal::Wrap<Lanes<S, W>>(-a.lane);
}

template <class S, int W>
DEFINITE_INLINE LaneMask<S, W> operator|(const LaneMask<S, W>& a, const LaneMask<S, W>& b) {
  return internal::Wrap<LaneMask<S, W>>(a.lane | b.lane);
}

// Whether it holds in any lane.
template <class S, int W>
DEFINITE_INLINE bool Any(const LaneMask<S, W>& m) {
#if defined(__AVX512DQ__)
  if constexpr (sizeof(S) == 8 && W == 8) return _mm512_movepi64_mask((__m512i)m.lane) != 0;
#endif
#if defined(__AVX__)
  if constexpr (sizeof(S) == 8 && W == 4) return _mm256_movemask_pd((__m256d)m.lane) != 0;
#endif
  typename LaneMask<S, W>::Integer any = 0;
  for (int i = 0; i < W; ++i) any |= m.lane[i];
  return any != 0;
}

template <class S, int W>
DEFINITE_INLINE Lanes<S, W> Select(const LaneMask<S, W>& m, const Lanes<S, W>& yes,
                                   const Lanes<S, W>& no) {
  return internal::Wrap<Lanes<S, W>>(m.lane ? yes.lane : no.lane);
}

// The larger and the smaller of two numbers; b where either is NaN. One instruction of two cycles,
// where a comparison and a selection take seven.
template <class S, int W>
DEFINITE_INLINE Lanes<S, W> Max(const Lanes<S, W>& a, const Lanes<S, W>& b) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<S, double> && W == 8) {
    return internal::Wrap<Lanes<S, W>>(_mm512_maskz_max_pd(0xff, a.lane, b.lane));
  }
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<S, double> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm256_max_pd(a.lane, b.lane));
  }
#endif
  return Select(a > b, a, b);
}

template <class S, int W>
DEFINITE_INLINE Lanes<S, W> Min(const Lanes<S, W>& a, const Lanes<S, W>& b) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<S, double> && W == 8) {
    return internal::Wrap<Lanes<S, W>>(_mm512_maskz_min_pd(0xff, a.lane, b.lane));
  }
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<S, double> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm256_min_pd(a.lane, b.lane));
  }
#endif
  return Select(a < b, a, b);
}

// a b + c with a single rounding.
template <class S, int W>
DEFINITE_INLINE Lanes<S, W> MulAdd(const Lanes<S, W>& a, const Lanes<S, W>& b,
                                   const Lanes<S, W>& c) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<S, double> && W == 8) {
    return internal::Wrap<Lanes<S, W>>(_mm512_fmadd_pd(a.lane, b.lane, c.lane));
  }
#endif
#if defined(__AVX__) && defined(__FMA__)
  if constexpr (std::is_same_v<S, double> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm256_fmadd_pd(a.lane, b.lane, c.lane));
  }
  if constexpr (std::is_same_v<S, float> && W == 8) {
    return internal::Wrap<Lanes<S, W>>(_mm256_fmadd_ps(a.lane, b.lane, c.lane));
  }
  if constexpr (std::is_same_v<S, float> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm_fmadd_ps(a.lane, b.lane, c.lane));
  }
#endif
  Lanes<S, W> r;
  for (int i = 0; i < W; ++i) r.lane[i] = std::fma(a.lane[i], b.lane[i], c.lane[i]);
  return r;
}

template <class S, int W>
DEFINITE_INLINE Lanes<S, W> Sqrt(const Lanes<S, W>& a) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<S, double> && W == 8) {
    // The unmasked form draws a false -Wmaybe-uninitialized from g++ 12.
    return internal::Wrap<Lanes<S, W>>(_mm512_maskz_sqrt_pd(0xff, a.lane));
  }
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<S, double> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm256_sqrt_pd(a.lane));
  }
  if constexpr (std::is_same_v<S, float> && W == 8) {
    return internal::Wrap<Lanes<S, W>>(_mm256_sqrt_ps(a.lane));
  }
  if constexpr (std::is_same_v<S, float> && W == 4) {
    return internal::Wrap<Lanes<S, W>>(_mm_sqrt_ps(a.lane));
  }
#endif
  Lanes<S, W> r;
  for (int i = 0; i < W; ++i) r.lane[i] = std::sqrt(a.lane[i]);
  return r;
}

}  // namespace definite
