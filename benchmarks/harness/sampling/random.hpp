#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace definite {

// The natural logarithm of a positive normal number, in + - * / alone: libm's differs between
// machines. Relative error below 3 u (u = 2^-53).
double PortableLog(double x);

// The inverse of the standard normal distribution function for p in (0,1), p normal, in
// + - * / sqrt alone. Source: Wichura 1988, Algorithm AS 241 (PPND16). Relative error below 1e-15.
double NormalQuantile(double p);

// FNV-1a, 64 bit: gives each named user of random numbers a stream of its own.
constexpr std::uint64_t StreamId(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

// The random numbers of one configuration. They are a function of (stream, seed, index) and of how
// many were taken before, so that any configuration can be drawn alone, on any thread, and has the
// same bits with every compiler (given -ffp-contract=off).
// Source: Salmon et al. 2011, Philox4x64-10, key (seed, stream), counter (index, block, 0, 0).
class Draws {
 public:
  Draws(std::uint64_t stream, std::uint64_t seed, std::uint64_t index)
      : stream_(stream), seed_(seed), index_(index) {}

  std::uint64_t Bits() {
    if (next_ == words_.size()) Refill();
    return words_[next_++];
  }

  // A multiple of 2^-53 in [0,1). (The conversion from a signed integer is one instruction.)
  double Uniform() {
    return static_cast<double>(static_cast<std::int64_t>(Bits() >> 11)) * 0x1p-53;
  }

  // An odd multiple of 2^-53 in (0,1): never 0, 1/2 or 1, and 1 - u is drawn as often as u.
  double OpenUniform() {
    return (static_cast<double>(static_cast<std::int64_t>(Bits() >> 12)) + 0.5) * 0x1p-52;
  }

  double Normal() { return NormalQuantile(OpenUniform()); }

 private:
  void Refill();

  std::uint64_t stream_, seed_, index_;
  std::uint64_t block_ = 0;
  std::array<std::uint64_t, 4> words_;
  std::size_t next_ = words_.size();
};

}  // namespace definite
