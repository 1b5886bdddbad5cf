#include "benchmarks/harness/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace definite {

namespace {

constexpr std::uint64_t kBlockUnit = 256, kMostBlocks = 1024, kMostShards = 1'000'000;

std::optional<std::uint64_t> WholeNumber(std::string_view text) {
  std::uint64_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  return value;
}

// Environment variables by which a launcher tells a process its part.
struct Launcher {
  const char *index, *count;
  const char* first;  // variable of the least index; null: it is 0
  const char* step;   // variable of the step from one index to the next; null: it is 1
};
constexpr Launcher kLaunchers[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN",
     "SLURM_ARRAY_TASK_STEP"},
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr, nullptr},
    {"PMI_RANK", "PMI_SIZE", nullptr, nullptr},
    {"GTEST_SHARD_INDEX", "GTEST_TOTAL_SHARDS", nullptr, nullptr},
    {"TEST_SHARD_INDEX", "TEST_TOTAL_SHARDS", nullptr, nullptr},
};

std::uint64_t Variable(const char* name) {
  const char* const text = std::getenv(name);
  if (!text) throw ShardError(fmt::format("auto: expected the variable {} too", name));
  const auto value = WholeNumber(text);
  if (!value)
    throw ShardError(fmt::format("auto: {} is '{}', expected a whole number", name, text));
  return *value;
}

Shard ShardOfEnvironment() {
  for (const Launcher& launcher : kLaunchers) {
    if (!std::getenv(launcher.index)) continue;
    const std::uint64_t index = Variable(launcher.index), count = Variable(launcher.count);
    const std::uint64_t first = launcher.first ? Variable(launcher.first) : 0;
    const std::uint64_t step =
        launcher.step && std::getenv(launcher.step) ? Variable(launcher.step) : 1;
    if (index < first || step == 0 || (index - first) % step != 0 ||
        (index - first) / step >= count || count > kMostShards) {
      throw ShardError(fmt::format("auto: {} = {} is not one of {} = {}", launcher.index, index,
                                   launcher.count, count));
    }
    return {(index - first) / step + 1, count};
  }
  std::string known;
  for (const Launcher& launcher : kLaunchers) known += fmt::format(" {}", launcher.index);
  throw ShardError("auto: expected one of these variables:" + known);
}

}  // namespace

std::uint64_t BlockSize(std::uint64_t count) {
  return std::max(kBlockUnit, CeilDivide(CeilDivide(count, kMostBlocks), kBlockUnit) * kBlockUnit);
}

Block BlockAt(std::uint64_t first, std::uint64_t count) {
  return {first, std::min(first + BlockSize(count), count)};
}

std::vector<Block> BlocksOf(std::uint64_t count, const Shard& shard) {
  const std::uint64_t size = BlockSize(count), all = CeilDivide(count, size);
  std::vector<Block> blocks;
  for (std::uint64_t i = all * (shard.index - 1) / shard.count; i < all * shard.index / shard.count;
       ++i) {
    blocks.push_back(BlockAt(i * size, count));
  }
  return blocks;
}

Shard ParseShard(const std::string& text) {
  if (text == "auto") return ShardOfEnvironment();
  const std::size_t slash = text.find('/');
  if (slash != text.npos) {
    const auto index = WholeNumber(std::string_view(text).substr(0, slash)),
               count = WholeNumber(std::string_view(text).substr(slash + 1));
    if (index && count && *index >= 1 && *index <= *count && *count <= kMostShards) {
      return {*index, *count};
    }
  }
  throw ShardError(
      fmt::format("'{}': expected a part such as 2/7, from 1/7 to 7/7, or auto", text));
}

}  // namespace definite
