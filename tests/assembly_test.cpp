// Scatter-add into a block-sparse matrix, against sums of dense matrices.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/sampling/random.hpp"
#include "kernels/assembly/block_sparse.hpp"

namespace definite {
namespace {

const std::string kEnergy = "collision/vertex_face/signed/quadratic/";

// Vertices in the unit cube and pairs of near numbers among them, in any order.
struct Mesh {
  int vertices;
  std::vector<double> x, p;
  std::vector<int> elements;

  Mesh(int vertex_count, int count) : vertices(vertex_count) {
    Draws draws(StreamId("assembly"), 1, static_cast<std::uint64_t>(vertex_count));
    const auto below = [&](int n) { return static_cast<int>(draws.Uniform() * n); };
    for (int i = 0; i < 3 * vertices; ++i) x.push_back(draws.Uniform());
    for (int e = 0; e < count; ++e) {
      const int first = below(vertices);
      std::vector<int> own;
      while (own.size() < 4) {
        const int v = (first + below(10)) % vertices;
        if (std::ranges::find(own, v) == own.end()) own.push_back(v);
      }
      elements.insert(elements.end(), own.begin(), own.end());
      for (double parameter : {1.0 + e, 1.0, 0.0}) p.push_back(parameter);
    }
  }

  ElementList List() const { return {4, elements}; }
};

BlockSparse MatrixOf(const Mesh& mesh) {
  const ElementList list = mesh.List();
  return {mesh.vertices, {&list, 1}};
}

BlockSparse Assembled(const Mesh& mesh, const std::string& row, int threads) {
  BlockSparse matrix = MatrixOf(mesh);
  Assembly(matrix, mesh.List()).Add(*FindKernel(kEnergy + row), mesh.x, mesh.p, threads, matrix);
  return matrix;
}

// The sum over all elements as a dense matrix, and of the absolute values of what is added.
struct Dense {
  std::size_t size;
  std::vector<double> sum, magnitude;

  Dense(const Mesh& mesh, const KernelRow& row)
      : size(static_cast<std::size_t>(3 * mesh.vertices)),
        sum(size * size),
        magnitude(size * size) {
    for (std::int64_t e = 0; e < mesh.List().Count(); ++e) {
      const int* element = mesh.elements.data() + 4 * e;
      double x[12], h[78];
      for (int i = 0; i < 12; ++i) {
        x[i] = mesh.x[static_cast<std::size_t>(3 * element[i / 3] + i % 3)];
      }
      RunOne(row, x, mesh.p.data() + 3 * e, h);
      const double* entry = h;
      const auto at = [&](int i) { return static_cast<std::size_t>(3 * element[i / 3] + i % 3); };
      for (int i = 0; i < 12; ++i) {
        for (int j = i; j < 12; ++j, ++entry) {
          Add(at(i), at(j), *entry);
          if (i != j) Add(at(j), at(i), *entry);
        }
      }
    }
  }

  void Add(std::size_t i, std::size_t j, double value) {
    sum[i * size + j] += value;
    magnitude[i * size + j] += std::abs(value);
  }
};

TEST(BlockSparse, HasABlockForEachPairOfVerticesThatShareAnElement) {
  const std::vector<int> triangle = {4, 1, 2}, edge = {3, 1};
  const ElementList lists[] = {{3, triangle}, {2, edge}};
  const BlockSparse matrix(6, lists);
  EXPECT_THAT(matrix.row_begin, ::testing::ElementsAre(0, 1, 5, 7, 8, 9, 10));
  EXPECT_THAT(matrix.column, ::testing::ElementsAre(0, 1, 2, 3, 4, 2, 4, 3, 4, 5));
  EXPECT_EQ(matrix.values.size(), 90u);
  EXPECT_EQ(matrix.Vertices(), 6);
  EXPECT_EQ(matrix.Find(1, 3), 3);
  EXPECT_EQ(matrix.Find(2, 3), -1);
  EXPECT_EQ(matrix.Find(0, 5), -1);
}

TEST(Assembly, SumsTheMatricesOfAllElements) {
  const Mesh mesh(40, 203);
  const KernelRow& row = *FindKernel(kEnergy + "nearest/f64");
  const BlockSparse matrix = Assembled(mesh, "nearest/f64", 2);
  const Dense dense(mesh, row);
  int nonzero = 0;
  for (int r = 0; r < mesh.vertices; ++r) {
    for (int c = r; c < mesh.vertices; ++c) {
      const std::int64_t block = matrix.Find(r, c);
      for (int k = 0; k < 9; ++k) {
        const auto at = static_cast<std::size_t>(3 * r + k / 3) * dense.size +
                        static_cast<std::size_t>(3 * c + k % 3);
        const double value = block < 0 ? 0 : matrix.values[static_cast<std::size_t>(9 * block + k)];
        ASSERT_NEAR(value, dense.sum[at], 1e-14 * dense.magnitude[at]) << r << " " << c << " " << k;
        if (value != 0) ++nonzero;
      }
    }
  }
  EXPECT_GT(nonzero, 1000);
}

TEST(Assembly, GivesTheSameBitsForAnyNumberOfThreadsAndLanes) {
  const Mesh mesh(60, 1001);
  const std::vector<double> values = Assembled(mesh, "analytic/f64", 1).values;
  for (int threads : {1, 2, 3, 7}) {
    EXPECT_EQ(Assembled(mesh, "analytic/f64", threads).values, values) << threads;
    EXPECT_EQ(Assembled(mesh, "analytic/f64x8", threads).values, values) << threads;
  }
}

TEST(Assembly, AddsToWhatIsThere) {
  const Mesh mesh(30, 50);
  BlockSparse matrix = MatrixOf(mesh);
  const Assembly assembly(matrix, mesh.List());
  const KernelRow& row = *FindKernel(kEnergy + "analytic/f64x8");
  for (int time = 0; time < 2; ++time) assembly.Add(row, mesh.x, mesh.p, 2, matrix);
  std::vector<double> half;
  for (double value : matrix.values) half.push_back(value / 2);
  const BlockSparse once = Assembled(mesh, "analytic/f64x8", 1);
  for (std::size_t i = 0; i < half.size(); ++i) {
    // Sums in another order; a block may cancel to far less than what was added.
    ASSERT_NEAR(half[i], once.values[i], 1e-12 * 50 * 10) << i;
  }
  matrix.SetZero();
  EXPECT_THAT(matrix.values, ::testing::Each(0.0));
}

TEST(Assembly, NoTwoElementsOfAColourShareAVertexAndEachElementHasOne) {
  // The first vertex is in all elements: more colours than the bits of one word.
  Mesh mesh(200, 150);
  for (std::size_t e = 0; e < 150; ++e) {
    for (std::size_t i = 0; i < 4; ++i) {
      int& v = mesh.elements[4 * e + i];
      if (v == 0) v = 1 + mesh.elements[4 * e + (i + 1) % 4];
    }
    mesh.elements[4 * e] = 0;
  }
  std::vector<int> distinct;
  for (std::size_t e = 0; e < 150; ++e) {
    const auto own = std::span(mesh.elements).subspan(4 * e, 4);
    if (std::set(own.begin(), own.end()).size() < 4) continue;
    distinct.insert(distinct.end(), own.begin(), own.end());
  }
  mesh.elements = distinct;
  const Assembly assembly(MatrixOf(mesh), mesh.List());
  EXPECT_EQ(assembly.Colours(), mesh.List().Count());
  EXPECT_GT(assembly.Colours(), 64);

  const Mesh other(500, 3000);
  const Assembly coloured(MatrixOf(other), other.List());
  std::vector<int> elements;
  for (int colour = 0; colour < coloured.Colours(); ++colour) {
    std::set<int> seen;
    EXPECT_TRUE(std::ranges::is_sorted(coloured.Colour(colour)));
    for (int e : coloured.Colour(colour)) {
      elements.push_back(e);
      for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(seen.insert(other.elements[static_cast<std::size_t>(4 * e + i)]).second) << e;
      }
    }
  }
  std::ranges::sort(elements);
  EXPECT_EQ(std::ssize(elements), 3000);
  EXPECT_EQ(std::ranges::adjacent_find(elements), elements.end());
  // Each vertex is in 24 elements on average: far fewer colours than elements.
  EXPECT_LT(coloured.Colours(), 100);
}

TEST(Assembly, NoElementsAreFine) {
  const Mesh mesh(5, 0);
  EXPECT_THAT(Assembled(mesh, "analytic/f64x8", 2).values, ::testing::Each(0.0));
}

// What an exception says.
template <class Action>
std::string Complaint(Action action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Assembly, SaysWhatDoesNotFit) {
  using ::testing::HasSubstr;
  const auto matrix_of = [](const std::vector<int>& elements, int size) {
    return Complaint([&] {
      const ElementList list{size, elements};
      BlockSparse(5, {&list, 1});
    });
  };
  EXPECT_THAT(matrix_of({0, 1, 2, 3, 0, 1, 2, 5}, 4), HasSubstr("element 1: vertex 5, expected 0"));
  EXPECT_THAT(matrix_of({-1, 1, 2, 3}, 4), HasSubstr("element 0: vertex -1, expected 0 to 4"));
  EXPECT_THAT(matrix_of({0, 1, 2, 1}, 4), HasSubstr("element 0: vertex 1 occurs twice"));
  EXPECT_THAT(matrix_of({0, 1, 2}, 4),
              HasSubstr("3 numbers of vertices: expected a multiple of 4"));

  const Mesh mesh(20, 9);
  BlockSparse matrix = MatrixOf(mesh);
  const Assembly assembly(matrix, mesh.List());
  const auto add = [&](const std::string& row, std::size_t xs, std::size_t ps, int threads) {
    return Complaint([&] {
      assembly.Add(*FindKernel(row), std::span(mesh.x).first(xs), std::span(mesh.p).first(ps),
                   threads, matrix);
    });
  };
  const std::string row = kEnergy + "analytic/f64";
  EXPECT_EQ(add(row, 60, 27, 1), "");
  EXPECT_THAT(add(row, 57, 27, 1), HasSubstr("x has 57 numbers, expected 60"));
  EXPECT_THAT(add(row, 60, 26, 1), HasSubstr("p has 26 numbers, expected 27"));
  EXPECT_THAT(add(row, 60, 27, 0), HasSubstr("0 threads: expected 1 or more"));
  const KernelRow& dense =
      *std::ranges::find(AllOutputs(), kEnergy + "analytic/f64x8/dense", &KernelRow::name);
  EXPECT_THAT(Complaint([&] { assembly.Add(dense, mesh.x, mesh.p, 1, matrix); }),
              HasSubstr("dense: expected a packed row of 12 degrees of freedom"));
  BlockSparse smaller = MatrixOf(Mesh(20, 1));
  EXPECT_THAT(Complaint([&] { assembly.Add(*FindKernel(row), mesh.x, mesh.p, 1, smaller); }),
              HasSubstr("the matrix has"));
  EXPECT_THAT(Complaint([&] { Assembly(MatrixOf(Mesh(20, 1)), mesh.List()); }),
              HasSubstr("the matrix has no block ("));
}

}  // namespace
}  // namespace definite
