#pragma once

// How a row runs: an energy and a filter over tiles, in the scalar type and with the output of the
// row.

#include <algorithm>
#include <new>
#include <string_view>
#include <type_traits>

#include "kernels/core/pair.hpp"
#include "kernels/kernel.hpp"
#include "kernels/outputs.hpp"

namespace definite {

// How a scalar type meets a tile: one configuration, or eight side by side. Eight is the storage,
// whatever the machine's vectors hold: `Value` may need several passes over a tile.
struct ScalarTile {
  static constexpr std::string_view kScalar = "f64";
  static constexpr int kLanes = 1, kPass = 1;
  using Value = double;
  static DEFINITE_INLINE double Load(const double* from) { return *from; }
  static DEFINITE_INLINE void Store(double value, double* to) { *to = value; }
};
struct LanesTile {
  static constexpr std::string_view kScalar = "f64x8";
  static constexpr int kLanes = 8, kPass = kNativeLanes;
  using Value = Lanes<double, kPass>;
  static DEFINITE_INLINE Value Load(const double* from) { return Value::Load(from); }
  static DEFINITE_INLINE void Store(const Value& value, double* to) { value.Store(to); }
};

// The numbers of one configuration, or of those that lie side by side, in a tile.
template <class Layout>
struct OutputTile {
  double* first;

  DEFINITE_INLINE void Store(int i, const typename Layout::Value& value) const {
    Layout::Store(value, first + i * Layout::kLanes);
  }
  DEFINITE_INLINE typename Layout::Value Load(int i) const {
    return Layout::Load(first + i * Layout::kLanes);
  }
};

// The configurations of one pass over a tile.
template <class E, class Layout>
struct Pass {
  Vec<typename Layout::Value, E::kDofs> x;
  Vec<typename Layout::Value, E::kParams> p;

  DEFINITE_INLINE Pass(const double* all_x, const double* all_p, long pass) {
    constexpr int kW = Layout::kLanes, kPasses = kW / Layout::kPass;
    const long tile = pass / kPasses, lane = pass % kPasses * Layout::kPass;
#pragma GCC unroll 16
    for (int i = 0; i < E::kDofs; ++i)
      x[i] = Layout::Load(all_x + (tile * E::kDofs + i) * kW + lane);
#pragma GCC unroll 16
    for (int i = 0; i < E::kParams; ++i) {
      p[i] = Layout::Load(all_p + (tile * E::kParams + i) * kW + lane);
    }
  }

  // Where its numbers go; tiles are kStride numbers apart.
  template <int kStride>
  static DEFINITE_INLINE OutputTile<Layout> TileOf(double* out, long pass) {
    constexpr int kW = Layout::kLanes, kPasses = kW / Layout::kPass;
    return {out + pass / kPasses * kStride * kW + pass % kPasses * Layout::kPass};
  }
};

// The same of two passes.
template <class Layout>
struct PairTile {
  OutputTile<Layout> a, b;

  DEFINITE_INLINE void Store(int i, const Pair<typename Layout::Value>& value) const {
    a.Store(i, value.a);
    b.Store(i, value.b);
  }
};

// Runs `compute(x, p, tile)` over the tiles, each `kStride` numbers after the one before it.
template <class E, class Tile, int kStride, class Compute>
DEFINITE_INLINE void ForTiles(const double* x, const double* p, double* out, long tiles,
                              Compute compute) {
  for (long pass = 0; pass < tiles * (Tile::kLanes / Tile::kPass); ++pass) {
    const Pass<E, Tile> in(x, p, pass);
    compute(in.x, in.p, Pass<E, Tile>::template TileOf<kStride>(out, pass));
  }
}

// The output of one pass: of the filter's result, or of the inputs themselves.
template <class E, class F, class Output, class T, class Tile>
DEFINITE_INLINE void WriteOutput(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p,
                                 const Tile& tile) {
  if constexpr (requires { Output::template WriteOf<F>(x, p, tile); }) {
    Output::template WriteOf<F>(x, p, tile);
  } else {
    Output::Write(F::template Apply<E>(x, p), tile);
  }
}

// A stage of a kernel over some passes, whose results wait in memory for the next stage. They are
// made in place: g++ 12 copies large results by calling memcpy, which took half of a kernel's time.
template <class Result, int kMany>
class Stage {
 public:
  template <class Make>
  DEFINITE_INLINE void Set(int i, Make make) {
    new (&slots_.results[i]) Result(make());
  }
  DEFINITE_INLINE Result& operator[](int i) { return slots_.results[i]; }

 private:
  static_assert(std::is_trivially_copyable_v<Result>);
  union Slots {
    Slots() {}
    Result results[kMany];
  };
  Slots slots_;
};

// Passes that a kernel with stages takes side by side: they hide each other's latencies, and no
// stage works on more numbers than the registers hold.
inline constexpr int kSideBySide = 4;

// The first stages of passes `first` to `first + count`: the filter's sums of modes.
template <class E, class F, class Tile, class Sums>
DEFINITE_INLINE void MakeSums(const double* x, const double* p, long first, int count, Sums& sums) {
  using T = typename Tile::Value;
  using P = Pass<E, Tile>;
  if constexpr (requires(const P& in) { F::template Begin<E>(in.x, in.p); }) {
    using State = decltype(F::template Begin<E>(Vec<T, E::kDofs>(), Vec<T, E::kParams>()));
    Stage<State, kSideBySide> states;
    for (int i = 0; i < count; ++i) {
      const P in(x, p, first + i);
      states.Set(
          i, [&in]() __attribute__((always_inline)) { return F::template Begin<E>(in.x, in.p); });
    }
    for (int step = 0; step < State::kRefinements; ++step) {
      for (int i = 0; i < count; ++i) states[i].Refine(step);
    }
    for (int i = 0; i < count; ++i) {
      sums.Set(
          i, [&states, i ]() __attribute__((always_inline)) { return states[i].Result(); });
    }
  } else {
    for (int i = 0; i < count; ++i) {
      const P in(x, p, first + i);
      sums.Set(
          i, [&in]() __attribute__((always_inline)) {
            return SumOf(F::template Apply<E>(in.x, in.p));
          });
    }
  }
}

template <class E, class F, class Tile, class Output>
void RunInStages(const double* x, const double* p, double* out, long passes) {
  using T = typename Tile::Value;
  using Sum = std::remove_cvref_t<decltype(SumOf(
      F::template Apply<E>(Vec<T, E::kDofs>(), Vec<T, E::kParams>())))>;
  Stage<Sum, kSideBySide> sums;
  for (long first = 0; first < passes; first += kSideBySide) {
    const int count = static_cast<int>(std::min<long>(kSideBySide, passes - first));
    MakeSums<E, F, Tile>(x, p, first, count, sums);
    for (int i = 0; i < count; ++i) {
      Output::Write(sums[i], Pass<E, Tile>::template TileOf<Output::kStride>(out, first + i));
    }
  }
}

template <class E, class F, class Tile, class Output>
void RunInPairs(const double* x, const double* p, double* out, long passes) {
  using P = Pass<E, Tile>;
  for (long first = 0; first < passes; first += 2) {
    const long second = std::min(first + 1, passes - 1);  // the last of an odd number is its own
    const P a(x, p, first), b(x, p, second);
    Vec<Pair<typename Tile::Value>, E::kDofs> xs;
    Vec<Pair<typename Tile::Value>, E::kParams> ps;
    for (int i = 0; i < E::kDofs; ++i) xs[i] = {a.x[i], b.x[i]};
    for (int i = 0; i < E::kParams; ++i) ps[i] = {a.p[i], b.p[i]};
    const PairTile<Tile> tile{P::template TileOf<Output::kStride>(out, first),
                              P::template TileOf<Output::kStride>(out, second)};
    WriteOutput<E, F, Output>(xs, ps, tile);
  }
}

// A row: the output of a filter of an energy. Scalars go one by one, for they have neither idle
// lanes nor too few registers.
template <class E, class F, class Tile, class Output>
void RunFilter(const double* x, const double* p, double* out, long tiles) {
  using P = Pass<E, Tile>;
  constexpr bool kSteps = requires(const P& in) { F::template Begin<E>(in.x, in.p); };
  constexpr bool kSums = Output::kOfSum && requires(const P& in) {
    SumOf(F::template Apply<E>(in.x, in.p));
  };
  const long passes = tiles * (Tile::kLanes / Tile::kPass);
  if constexpr (Tile::kLanes > 1 && (kSteps || kSums)) {
    RunInStages<E, F, Tile, Output>(x, p, out, passes);
  } else if constexpr (Tile::kLanes > 1 && kPaired<F>) {
    RunInPairs<E, F, Tile, Output>(x, p, out, passes);
  } else {
    ForTiles<E, Tile, Output::kStride>(
        x, p, out, tiles,
        [](const auto& xs, const auto& ps, const auto& tile)
            __attribute__((always_inline)) { WriteOutput<E, F, Output>(xs, ps, tile); });
  }
}

}  // namespace definite
