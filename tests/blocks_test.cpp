#include "benchmarks/harness/blocks.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace definite {
namespace {

TEST(Blocks, OfAllShardsAreAllBlocksOnceInOrder) {
  for (std::uint64_t count : {1u, 255u, 256u, 257u, 3001u, 1'000'000u, 10'000'019u}) {
    const std::vector<Block> all = BlocksOf(count, {});
    EXPECT_LE(all.size(), 1024u);
    for (std::uint64_t shards : {1u, 2u, 3u, 7u, 2000u}) {
      std::uint64_t end = 0;
      std::size_t blocks = 0;
      for (std::uint64_t i = 1; i <= shards; ++i) {
        for (const Block& block : BlocksOf(count, {i, shards})) {
          EXPECT_EQ(block.first, end);
          EXPECT_EQ(block.first, all[blocks].first);
          EXPECT_EQ(block.end, BlockAt(block.first, count).end);
          end = block.end;
          ++blocks;
        }
      }
      EXPECT_EQ(end, count);
      EXPECT_EQ(blocks, all.size());
    }
  }
}

TEST(Blocks, AreWholeChunks) {
  EXPECT_EQ(BlockSize(1), 256u);
  EXPECT_EQ(BlockSize(256 * 1024), 256u);
  EXPECT_EQ(BlockSize(256 * 1024 + 1), 512u);
  EXPECT_EQ(BlockSize(10'000'000), 9984u);
}

TEST(Shards, AreEqualUpToABlock) {
  const std::size_t all = BlocksOf(10'000'000, {}).size();
  for (std::uint64_t i = 1; i <= 7; ++i) {
    const std::size_t mine = BlocksOf(10'000'000, {i, 7}).size();
    EXPECT_GE(mine, all / 7);
    EXPECT_LE(mine, all / 7 + 1);
  }
}

TEST(Shards, AreRead) {
  EXPECT_EQ(ParseShard("1/1"), (Shard{1, 1}));
  EXPECT_EQ(ParseShard("2/7"), (Shard{2, 7}));
  for (const char* bad :
       {"", "2", "0/7", "8/7", "-1/7", "1/0", "a/b", "1/2/3", "1/7 ", "1/9999999"}) {
    EXPECT_THROW(ParseShard(bad), ShardError) << bad;
  }
}

// Variables that are unset again.
class Environment : public ::testing::Test {
 protected:
  void Set(const char* name, const char* value) {
    setenv(name, value, 1);
    set_.push_back(name);
  }
  void Unset() {
    for (const char* name : set_) unsetenv(name);
    set_.clear();
  }
  void TearDown() override { Unset(); }

 private:
  std::vector<const char*> set_;
};

TEST_F(Environment, SaysWhichShard) {
  EXPECT_THROW(ParseShard("auto"), ShardError);
  Set("SLURM_ARRAY_TASK_ID", "14");
  EXPECT_THROW(ParseShard("auto"), ShardError);
  Set("SLURM_ARRAY_TASK_MIN", "10");
  Set("SLURM_ARRAY_TASK_COUNT", "5");
  EXPECT_EQ(ParseShard("auto"), (Shard{5, 5}));
  Set("SLURM_ARRAY_TASK_STEP", "2");
  EXPECT_EQ(ParseShard("auto"), (Shard{3, 5}));
  Set("SLURM_ARRAY_TASK_ID", "15");
  EXPECT_THROW(ParseShard("auto"), ShardError);
  Unset();
  for (const auto& [index, count] : {std::pair("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
                                     {"PMI_RANK", "PMI_SIZE"},
                                     {"GTEST_SHARD_INDEX", "GTEST_TOTAL_SHARDS"},
                                     {"TEST_SHARD_INDEX", "TEST_TOTAL_SHARDS"}}) {
    Set(index, "3");
    Set(count, "4");
    EXPECT_EQ(ParseShard("auto"), (Shard{4, 4})) << index;
    Set(index, "4");
    EXPECT_THROW(ParseShard("auto"), ShardError) << index;
    Set(index, "three");
    EXPECT_THROW(ParseShard("auto"), ShardError) << index;
    Unset();
  }
}

}  // namespace
}  // namespace definite
