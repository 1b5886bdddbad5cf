#include "benchmarks/speed/roofline.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "kernels/core/lanes.hpp"

namespace definite {

namespace {

using L = Lanes<double, kNativeLanes>;
constexpr double kShortestSweep = 2e-3;  // seconds of one measurement
constexpr int kRounds = 9;

// The most per second of `amount` that work(repetitions) does `repetitions` times over.
template <class Work>
double BestRate(double amount, Work work) {
  std::int64_t repetitions = 1;
  double seconds = 0;
  for (;; repetitions *= 2) {
    const double start = ThreadSeconds();
    work(repetitions);
    seconds = ThreadSeconds() - start;
    if (seconds > kShortestSweep) break;
  }
  for (int round = 1; round < kRounds; ++round) {
    const double start = ThreadSeconds();
    work(repetitions);
    seconds = std::min(seconds, ThreadSeconds() - start);
  }
  return amount * static_cast<double>(repetitions) / seconds;
}

DEFINITE_INLINE void KeepInRegister(L& value) { asm volatile("" : "+v"(value.lane)); }

// Independent chains of step(c, value), enough to hide the latency of each. Written out by the
// template: an array under a loop stays in memory, and its stores would be what is timed.
template <class Step, int... c>
double RateOf(Step step, std::integer_sequence<int, c...>) {
  constexpr int kSteps = 64;
  return BestRate(kSteps * sizeof...(c), [step](std::int64_t repetitions) {
    L value[] = {L(1.0 + c)...};
    for (std::int64_t r = 0; r < repetitions; ++r) {
      for (int s = 0; s < kSteps; ++s) {
        ((value[c] = step(c, value[c]), KeepInRegister(value[c])), ...);
      }
    }
  });
}
template <int kChains, class Step>
double RateOf(Step step) {
  return RateOf(step, std::make_integer_sequence<int, kChains>());
}

void MeasureArithmetic(Roofline& roofline) {
  const L factor(0.999), term(0.001);
  const auto fused = [=](int, const L& v) __attribute__((always_inline)) {
    return MulAdd(v, factor, term);
  };
  // Some machines have units of their own for additions: every second chain adds.
  const auto mixed = [=](int c, const L& v) __attribute__((always_inline)) {
    return c % 2 == 0 ? MulAdd(v, factor, term) : v + term;
  };
  roofline.fused = RateOf<10>(fused);
  constexpr int kChains = kNativeLanes == 8 ? 24 : 14;  // twice as many registers
  roofline.arithmetic = std::max(roofline.fused, RateOf<kChains>(mixed));
}

double StoreRate(Level level) {
  const std::int64_t bytes = RingBytes(level);
  AlignedDoubles ring;
  ring.Resize(static_cast<std::size_t>(bytes) / sizeof(double));
  double* const begin = ring.Data();
  const std::int64_t numbers = bytes / static_cast<std::int64_t>(sizeof(double));
  return BestRate(static_cast<double>(bytes), [=](std::int64_t repetitions) {
    L value(1.0);
    for (std::int64_t r = 0; r < repetitions; ++r) {
      for (std::int64_t i = 0; i < numbers; i += kNativeLanes) {
        if (level == Level::kMemory) {
          value.Stream(begin + i);
        } else {
          value.Store(begin + i);
        }
        asm volatile("" : : : "memory");
      }
    }
  });
}

}  // namespace

std::int64_t RingBytes(Level level) {
  switch (level) {
    case Level::kL1:
      return 16 << 10;
    case Level::kL2:
      return 256 << 10;
    case Level::kMemory:
      return 256 << 20;
  }
  return 0;
}

Roofline MeasureRoofline() {
  Roofline roofline;
  MeasureArithmetic(roofline);
  const L two(2.0);
  roofline.divisions =
      RateOf<8>([=](int, const L& v) __attribute__((always_inline)) { return two / v; });
  roofline.roots =
      RateOf<8>([](int, const L& v) __attribute__((always_inline)) { return Sqrt(v); });
  for (Level level : {Level::kL1, Level::kL2, Level::kMemory}) {
    roofline.stores[static_cast<int>(level)] = StoreRate(level);
  }
  return roofline;
}

}  // namespace definite
