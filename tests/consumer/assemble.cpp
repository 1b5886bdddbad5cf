// Sums the filtered Hessians of contacts that share vertices into one block-sparse matrix, on two
// threads, and sees that a translation of all vertices feels no force.

#include <cmath>
#include <cstdio>
#include <vector>

#include "kernels/assembly/block_sparse.hpp"
#include "kernels/kernel.hpp"

int main() {
  // Vertices 4 and 5 close to the triangles (0, 1, 2) and (1, 3, 2) of a square.
  const std::vector<double> x = {0, 0, 0, 1,   0,   0,    0,   1,   0,
                                 1, 1, 0, 0.3, 0.2, 0.05, 0.6, 0.7, -0.05};
  const std::vector<int> contacts = {4, 0, 1, 2, 5, 1, 3, 2};
  const std::vector<double> p = {1e3, 0.1, 1, 1e3, 0.1, 1};  // k, eps, side of each

  const definite::ElementList list{4, contacts};  // a solver adds its tetrahedra here
  definite::BlockSparse matrix(6, {&list, 1});    // vertices, and all lists that have blocks in it
  const definite::Assembly assembly(matrix, list);

  const definite::KernelRow* row =
      definite::FindKernel("collision/vertex_face/signed/quadratic/nearest/f64x8");
  if (!row) {
    std::fputs("this build of definite has no such row\n", stderr);
    return 1;
  }
  assembly.Add(*row, x, p, 2, matrix);  // two threads; the same bits for any number

  // Row sums over a symmetric matrix of which we hold the upper triangle.
  std::vector<double> sums(x.size());
  double largest = 0;
  for (int r = 0; r < matrix.Vertices(); ++r) {
    const auto row_of = static_cast<std::size_t>(r);
    for (auto b = matrix.row_begin[row_of]; b < matrix.row_begin[row_of + 1]; ++b) {
      const auto column = static_cast<std::size_t>(matrix.column[static_cast<std::size_t>(b)]);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double value = matrix.values[9 * static_cast<std::size_t>(b) + 3 * i + j];
          sums[3 * row_of + i] += value;
          if (column != row_of) sums[3 * column + j] += value;
          largest = std::fmax(largest, std::fabs(value));
        }
      }
    }
  }
  bool balanced = largest > 0;
  for (std::size_t i = 0; i < 18; i += 3) {
    balanced = balanced && std::fabs(sums[i] + sums[i + 1] + sums[i + 2]) <= 1e-12 * largest;
  }
  std::printf("2 contacts in %d colours, %zu blocks: translations %s\n", assembly.Colours(),
              matrix.column.size(), balanced ? "cost nothing" : "are resisted");
  return balanced ? 0 : 1;
}
