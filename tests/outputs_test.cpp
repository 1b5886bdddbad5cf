// What rows write that are not packed, against the packed row of the same filter; and what they
// count.

#include "kernels/outputs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "kernels/core/counting.hpp"

namespace definite {
namespace {

constexpr int kPairs = 64;

// What a row makes of the numbers in `before` for the pairs of `active`, in scalar layout.
std::vector<double> OutputsOf(const KernelRow& row, std::vector<double> before) {
  Batch batch(*row.energy);
  batch.Draw(*FindDistribution("active"), 11, 0, kPairs);
  std::vector<double> tiles(before.size());
  if (row.lanes == 1) {
    tiles = before;
  } else {
    ToTiles(before.data(), row.outputs, kPairs, tiles.data());
  }
  row.run(batch.TilesX(row.lanes, 0), batch.TilesP(row.lanes, 0), tiles.data(), kPairs / row.lanes);
  if (row.lanes == 1) return tiles;
  FromTiles(tiles.data(), row.outputs, kPairs, before.data());
  return before;
}
std::vector<double> OutputsOf(const KernelRow& row) {
  return OutputsOf(row, std::vector<double>(static_cast<std::size_t>(kPairs * row.outputs)));
}

const KernelRow& PackedOf(const KernelRow& row) {
  return *FindKernel(row.name.substr(0, row.name.rfind('/')));
}

class Outputs : public ::testing::TestWithParam<const KernelRow*> {
 protected:
  const KernelRow& row_ = *GetParam();
  const std::vector<double> packed_ = OutputsOf(PackedOf(row_));
  const int dofs_ = row_.energy->dofs, size_ = dofs_ * (dofs_ + 1) / 2;

  double Entry(int pair, int i, int j) const {
    return packed_[static_cast<std::size_t>(
        pair * size_ + internal::PackedIndex(std::min(i, j), std::max(i, j), dofs_))];
  }
};

class Dense : public Outputs {};
TEST_P(Dense, HasTheEntriesOfThePackedMatrixTwice) {
  const std::vector<double> dense = OutputsOf(row_);
  for (int pair = 0; pair < kPairs; ++pair) {
    for (int i = 0; i < dofs_; ++i) {
      for (int j = 0; j < dofs_; ++j) {
        ASSERT_EQ(dense[static_cast<std::size_t>((pair * dofs_ + i) * dofs_ + j)],
                  Entry(pair, i, j))
            << pair << " " << i << " " << j;
      }
    }
  }
}

class AppliedToAVector : public Outputs {};
TEST_P(AppliedToAVector, AddsTheProductAndLeavesTheVector) {
  const auto y = [](int pair, int i) { return std::cos(1.0 + 5 * pair + i); };
  const auto d = [](int pair, int i) { return std::sin(1.0 + 7 * pair + i); };
  const auto at = [this](int pair, int i) {
    return static_cast<std::size_t>(pair * row_.outputs + i);
  };
  std::vector<double> scalar(static_cast<std::size_t>(kPairs * row_.outputs));
  for (int pair = 0; pair < kPairs; ++pair) {
    for (int i = 0; i < dofs_; ++i) {
      scalar[at(pair, i)] = y(pair, i);
      scalar[at(pair, dofs_ + i)] = d(pair, i);
    }
  }
  scalar = OutputsOf(row_, scalar);
  for (int pair = 0; pair < kPairs; ++pair) {
    double scale2 = 0, error2 = 0;
    for (int i = 0; i < dofs_; ++i) {
      double expected = y(pair, i);
      for (int j = 0; j < dofs_; ++j) {
        expected += Entry(pair, i, j) * d(pair, j);
        scale2 += Entry(pair, i, j) * Entry(pair, i, j) * dofs_;
      }
      const double error = scalar[at(pair, i)] - expected;
      error2 += error * error;
      EXPECT_EQ(scalar[at(pair, dofs_ + i)], d(pair, i));
    }
    EXPECT_LE(std::sqrt(error2), 50 * kUnit * (dofs_ + std::sqrt(scale2))) << pair;
  }
}

class BlockSum : public Outputs {};
TEST_P(BlockSum, AddsUpTheMatricesOfACall) {
  constexpr double kBefore = 2;
  Batch batch(*row_.energy);
  batch.Draw(*FindDistribution("active"), 11, 0, kPairs);
  std::vector<double> sums(static_cast<std::size_t>(row_.lanes * row_.outputs), kBefore);
  row_.run(batch.TilesX(row_.lanes, 0), batch.TilesP(row_.lanes, 0), sums.data(),
           kPairs / row_.lanes);
  for (int lane = 0; lane < row_.lanes; ++lane) {
    for (int k = 0; k < size_; ++k) {
      double expected = kBefore;
      for (int pair = lane; pair < kPairs; pair += row_.lanes) {
        expected += packed_[static_cast<std::size_t>(pair * size_ + k)];
      }
      EXPECT_EQ(sums[static_cast<std::size_t>(k * row_.lanes + lane)], expected)
          << lane << " " << k;
    }
  }
}

std::vector<const KernelRow*> RowsOf(const std::string& output) {
  std::vector<const KernelRow*> rows;
  for (const KernelRow& row : AllOutputs()) {
    if (row.output == output) rows.push_back(&row);
  }
  return rows;
}
std::string TestName(const ::testing::TestParamInfo<const KernelRow*>& p) {
  std::string name = p.param->name;
  std::ranges::replace(name, '/', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Registry, Dense, ::testing::ValuesIn(RowsOf("dense")), TestName);
INSTANTIATE_TEST_SUITE_P(Registry, AppliedToAVector, ::testing::ValuesIn(RowsOf("applied")),
                         TestName);
INSTANTIATE_TEST_SUITE_P(Registry, BlockSum, ::testing::ValuesIn(RowsOf("block_sum")), TestName);

TEST(Counting, CountsEachOperationOnce) {
  const Counting a(2), b(3);
  Counting::done = {};
  const Counting c = MulAdd(a, b, a + b) - Sqrt(a * b) / b;
  EXPECT_EQ(c.value, 6 + 5 - std::sqrt(6.0) / 3);
  const Operations& o = Counting::done;
  EXPECT_EQ(o.additions, 2);
  EXPECT_EQ(o.multiplications, 1);
  EXPECT_EQ(o.fused, 1);
  EXPECT_EQ(o.divisions, 1);
  EXPECT_EQ(o.roots, 1);
  EXPECT_EQ(o.Arithmetic(), 4);
}

// A comparison of rows by what they count is of no use if one of them counts nothing.
TEST(Counting, SeesAllRowsOfTheStudiedEnergies) {
  int counted = 0;
  for (const KernelRow& row : AllKernels()) {
    if (!row.count) continue;
    Batch batch(*row.energy);
    batch.Draw(*FindDistribution("active"), 11, 0, kTile);
    const Operations o = row.count(batch.X(0), batch.P(0));
    EXPECT_GT(o.Arithmetic(), 50) << row.name;
    EXPECT_EQ(o.stores, row.outputs) << row.name;
    ++counted;
  }
  EXPECT_GE(counted, 5);
}

}  // namespace
}  // namespace definite
