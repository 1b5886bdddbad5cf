#pragma once

// How the configurations 0 .. count-1 of a plan are cut: into blocks that do not depend on who
// works on them, and those into shards, for several processes or machines. Whatever is kept of a
// run is kept of whole blocks, so that parts of it can be put together and an interrupted one
// resumed.

#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace definite {

template <std::integral I>
constexpr I CeilDivide(I a, I b) {
  return (a + b - 1) / b;
}

struct Block {
  std::uint64_t first, end;  // of the configurations
  std::uint64_t Size() const { return end - first; }
};

// Part `index` of `count`, from 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
  friend bool operator==(const Shard&, const Shard&) = default;
};

// At most 1024 blocks, each but the last of a multiple of 256 configurations.
std::uint64_t BlockSize(std::uint64_t count);
Block BlockAt(std::uint64_t first, std::uint64_t count);

// The blocks of a shard, in their order: every block is in one of the shards. A shard has none if
// there are more shards than blocks.
std::vector<Block> BlocksOf(std::uint64_t count, const Shard& shard);

class ShardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// "2/7"; or "auto": what the environment says of a Slurm array, an MPI launcher, GoogleTest or
// Bazel's sharding. Throws ShardError.
Shard ParseShard(const std::string& text);

}  // namespace definite
