#pragma once

// Where double precision ends: the thresholds that bound the domains of the energies, and what an
// iteration may leave.

#include "kernels/core/lanes.hpp"

namespace definite {

// The cube root of the unit roundoff: where an iteration of third order may stop.
template <class T>
inline constexpr double kUnitCubeRoot = 1e-12;  // float128 and wider
template <>
inline constexpr double kUnitCubeRoot<double> = 5e-6;
template <int W>
inline constexpr double kUnitCubeRoot<Lanes<double, W>> = 5e-6;

// The unit roundoff: half the distance from 1 to the next number.
template <class T>
inline constexpr double kUnitRoundoff = 0x1p-113;  // float128 and wider
template <>
inline constexpr double kUnitRoundoff<double> = 0x1p-53;
template <int W>
inline constexpr double kUnitRoundoff<Lanes<double, W>> = 0x1p-53;

// The sine under which two edges count as parallel; a constant of the protocol.
inline constexpr double kTau = 1e-8;
// In units of the largest edge component: distances below which primitives touch, and edges below
// which a pair is out of domain, for what hangs on such an edge is far less than a rounding error
// of the rest. The area of two edges in the domain is larger than kLeastArea.
inline constexpr double kLeastLength = 0x1p-100, kLeastEdge = 0x1p-56;
inline constexpr double kLeastArea = kTau * (kLeastEdge * kLeastEdge);

}  // namespace definite
