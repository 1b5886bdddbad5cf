// The golden lists: what rows there are, and what they promise.

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "benchmarks/harness/promises.hpp"
#include "reference/oracle.hpp"

namespace definite {
namespace {

std::string Contents(const std::string& path) {
  std::ifstream file(std::string(DEFINITE_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Catalogue, ListsTheRowsThereAre) {
  std::string names;
  for (const KernelRow& row : AllKernels()) names += row.name + "\n";
  EXPECT_EQ(names, Contents("kernels/CATALOGUE.txt"))
      << "If the change is meant: definite list > kernels/CATALOGUE.txt";
}

TEST(Catalogue, ListsThePromises) {
  EXPECT_EQ(PromiseTable(), Contents("kernels/PROMISES.txt"))
      << "If the change is meant: definite list --promises > kernels/PROMISES.txt";
}

// Each takes about half a second to build.
TEST(Catalogue, HasAtMostTwelveHundredRows) { EXPECT_LE(AllKernels().size(), 1200u); }

TEST(Catalogue, HasEachNameOnce) {
  std::set<std::string> names;
  for (const KernelRow& row : AllKernels()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(FindKernel(row.name), &row);
  }
  EXPECT_EQ(FindKernel("collision"), nullptr);
}

TEST(Catalogue, HasAReferenceForEachEnergyAndFilter) {
  for (const EnergyRow& energy : AllEnergies()) {
    const auto* reference = reference::FindEnergy<double>(energy.name);
    ASSERT_NE(reference, nullptr) << energy.name;
    EXPECT_EQ(reference->dofs, energy.dofs);
    EXPECT_EQ(reference->params, static_cast<int>(energy.parameters.size()));
  }
  for (const KernelRow& row : AllKernels()) {
    EXPECT_NE(reference::FindFilter<double>(row.filter), nullptr) << row.filter;
  }
}

TEST(Catalogue, GivesAReasonForEachExemption) {
  for (const KernelRow& row : AllKernels()) {
    for (const Exemption& e : row.exempt) EXPECT_GE(e.why.size(), 15u) << row.name;
  }
}

}  // namespace
}  // namespace definite
