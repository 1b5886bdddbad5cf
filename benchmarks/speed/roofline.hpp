#pragma once

// What this machine can do at most, measured: the rates behind the floors of docs/protocol.md,
// section 3.

#include <cstdint>

namespace definite {

// Where a ring of outputs lies.
enum class Level { kL1, kL2, kMemory };

struct Roofline {
  // Vector instructions a second on one core, of kNativeLanes doubles each.
  double fused;       // fused multiply-adds
  double arithmetic;  // additions and fused multiply-adds, mixed as runs fastest
  double divisions, roots;
  // Bytes a second that one core stores; to memory with streaming stores.
  double stores[3];  // by Level

  double Stores(Level level) const { return stores[static_cast<int>(level)]; }
};

// Takes about half a second.
Roofline MeasureRoofline();

// Bytes of a ring that lies in a level: half of it, and for memory far more than any cache.
std::int64_t RingBytes(Level level);

}  // namespace definite
