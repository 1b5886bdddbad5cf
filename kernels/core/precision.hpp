#pragma once

// Where double precision ends: the thresholds that bound the domains of the energies.

namespace definite {

// The sine under which two edges count as parallel; a constant of the protocol.
inline constexpr double kTau = 1e-8;
// Lengths and areas below these (in units of the largest edge component) give Hessians that double
// precision cannot hold.
inline constexpr double kLeastLength = 0x1p-450, kLeastArea = 0x1p-450;

}  // namespace definite
