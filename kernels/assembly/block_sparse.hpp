#pragma once

// From many small matrices to the one of a solver: a row's matrices, scatter-added to a
// block-sparse matrix on several threads.

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/kernel.hpp"

namespace definite {

// Elements with `size` vertices each, numbered from 0: vertex i of element e is
// vertices[e * size + i]. It refers to numbers that live elsewhere.
struct ElementList {
  int size;
  std::span<const int> vertices;

  std::int64_t Count() const { return std::ssize(vertices) / size; }
};

// A symmetric matrix of 3x3 blocks, one for each pair of vertices that share an element: the upper
// triangle in compressed sparse rows. Block b of row r, row_begin[r] <= b < row_begin[r + 1], lies
// in column[b] >= r, ascending; its nine numbers are values[9 b ...], row by row. Each row begins
// with its diagonal block, which is there even where no element is.
class BlockSparse {
 public:
  // The pattern of all elements in the lists, every value 0. Throws std::invalid_argument, naming
  // the element, where a vertex is not in 0 .. vertices - 1 or occurs twice in one element.
  BlockSparse(int vertices, std::span<const ElementList> lists);

  int Vertices() const { return static_cast<int>(row_begin.size()) - 1; }
  // Where block (r, c), r <= c, is; -1 where the pattern has none.
  std::int64_t Find(int r, int c) const;
  void SetZero();

  std::vector<std::int64_t> row_begin;
  std::vector<int> column;
  std::vector<double> values;
};

// Adds the elements of one list to a matrix. They are coloured: no two of a colour share a vertex,
// and the colours are added one after another. So threads never meet in a block, and each block is
// summed in one order: the result is the same, bit for bit, whatever the number of threads.
class Assembly {
 public:
  // Keeps its own copy of the list. Throws std::invalid_argument where the pattern lacks a block.
  Assembly(const BlockSparse& matrix, const ElementList& list);

  std::int64_t Elements() const { return std::ssize(order_); }
  int Colours() const { return static_cast<int>(colour_begin_.size()) - 1; }
  // The elements of a colour, by their place in the list.
  std::span<const int> Colour(int colour) const;

  // matrix += the row's matrix of every element, for vertices at x (3 numbers each) and elements
  // with parameters p (one after another, in the order of EnergyRow::parameters). The matrix is the
  // one of the constructor, or has its pattern. Throws std::invalid_argument where the row is not
  // packed or is of another size than the elements, or where x, p or the matrix do not fit.
  void Add(const KernelRow& row, std::span<const double> x, std::span<const double> p, int threads,
           BlockSparse& matrix) const;

 private:
  struct Buffers;
  void AddElements(const KernelRow& row, const double* x, const double* p, std::int64_t first,
                   std::int64_t last, Buffers& buffers, double* values) const;

  int size_;                                // vertices of an element
  std::int64_t blocks_;                     // of the matrix
  std::vector<int> order_;                  // elements by colour, then by place in the list
  std::vector<std::int64_t> colour_begin_;  // in order_
  std::vector<int> vertices_;               // size_ for each element, in the order of order_
  // For each element and each pair i <= j of its vertices: where its block begins in the values; as
  // -1 - place if the block wants the transpose, for vertex i comes after vertex j.
  std::vector<std::int64_t> places_;
};

}  // namespace definite
