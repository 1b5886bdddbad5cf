#include "kernels/assembly/block_sparse.hpp"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "kernels/core/aligned_doubles.hpp"

namespace definite {

namespace {

constexpr int kBlockNumbers = 9;
constexpr std::int64_t kBatch = 32;  // elements whose packed matrices (20 kB for 12x12) stay in L1

[[noreturn]] void Refuse(const std::string& what) { throw std::invalid_argument(what); }

constexpr int PairsOf(int size) { return size * (size + 1) / 2; }

void Check(const ElementList& list, int vertices) {
  if (list.size < 1 || std::ssize(list.vertices) % list.size != 0) {
    Refuse(std::to_string(list.vertices.size()) + " numbers of vertices: expected a multiple of " +
           std::to_string(list.size) + ", the vertices of an element");
  }
  for (std::int64_t e = 0; e < list.Count(); ++e) {
    const auto element = list.vertices.subspan(static_cast<std::size_t>(e * list.size),
                                               static_cast<std::size_t>(list.size));
    for (auto v = element.begin(); v != element.end(); ++v) {
      if (*v < 0 || *v >= vertices) {
        Refuse("element " + std::to_string(e) + ": vertex " + std::to_string(*v) +
               ", expected 0 to " + std::to_string(vertices - 1));
      }
      if (std::find(element.begin(), v, *v) != v) {
        Refuse("element " + std::to_string(e) + ": vertex " + std::to_string(*v) + " occurs twice");
      }
    }
  }
}

// The least colour that no vertex of each element has met yet.
std::vector<int> ColoursOf(const ElementList& list, int vertices) {
  std::vector<std::vector<std::uint64_t>> met(static_cast<std::size_t>(vertices));
  std::vector<int> colours;
  colours.reserve(static_cast<std::size_t>(list.Count()));
  for (auto element = list.vertices; !element.empty();
       element = element.subspan(static_cast<std::size_t>(list.size))) {
    const auto own = element.first(static_cast<std::size_t>(list.size));
    std::size_t word = 0;
    std::uint64_t taken;
    do {
      taken = 0;
      for (int v : own) {
        const auto& words = met[static_cast<std::size_t>(v)];
        if (word < words.size()) taken |= words[word];
      }
    } while (taken == ~std::uint64_t{0} && ++word > 0);
    const int bit = std::countr_one(taken);
    for (int v : own) {
      auto& words = met[static_cast<std::size_t>(v)];
      words.resize(std::max(words.size(), word + 1));
      words[word] |= std::uint64_t{1} << bit;
    }
    colours.push_back(static_cast<int>(word) * 64 + bit);
  }
  return colours;
}

}  // namespace

BlockSparse::BlockSparse(int vertices, std::span<const ElementList> lists) {
  std::vector<std::pair<int, int>> blocks;
  for (int v = 0; v < vertices; ++v) blocks.emplace_back(v, v);
  for (const ElementList& list : lists) {
    Check(list, vertices);
    for (std::int64_t e = 0; e < list.Count(); ++e) {
      const int* element = list.vertices.data() + e * list.size;
      for (int i = 0; i < list.size; ++i) {
        for (int j = i + 1; j < list.size; ++j)
          blocks.push_back(std::minmax(element[i], element[j]));
      }
    }
  }
  std::ranges::sort(blocks);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  row_begin.assign(static_cast<std::size_t>(vertices) + 1, 0);
  column.reserve(blocks.size());
  for (const auto& [r, c] : blocks) {
    ++row_begin[static_cast<std::size_t>(r) + 1];
    column.push_back(c);
  }
  std::partial_sum(row_begin.begin(), row_begin.end(), row_begin.begin());
  values.resize(blocks.size() * kBlockNumbers);
}

std::int64_t BlockSparse::Find(int r, int c) const {
  const auto first = column.begin() + row_begin[static_cast<std::size_t>(r)],
             last = column.begin() + row_begin[static_cast<std::size_t>(r) + 1];
  const auto at = std::lower_bound(first, last, c);
  return at != last && *at == c ? at - column.begin() : -1;
}

void BlockSparse::SetZero() { std::ranges::fill(values, 0.0); }

Assembly::Assembly(const BlockSparse& matrix, const ElementList& list)
    : size_(list.size), blocks_(std::ssize(matrix.column)) {
  Check(list, matrix.Vertices());
  const std::vector<int> colours = ColoursOf(list, matrix.Vertices());
  order_.resize(colours.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::ranges::stable_sort(order_, {}, [&](int e) { return colours[static_cast<std::size_t>(e)]; });
  for (std::int64_t at = 0; at < Elements(); ++at) {
    const int e = order_[static_cast<std::size_t>(at)];
    if (colours[static_cast<std::size_t>(e)] == std::ssize(colour_begin_))
      colour_begin_.push_back(at);
    const int* element = list.vertices.data() + std::int64_t{e} * size_;
    vertices_.insert(vertices_.end(), element, element + size_);
    for (int i = 0; i < size_; ++i) {
      for (int j = i; j < size_; ++j) {
        const auto [r, c] = std::minmax(element[i], element[j]);
        const std::int64_t place = matrix.Find(r, c) * kBlockNumbers;
        if (place < 0) {
          Refuse("element " + std::to_string(e) + ": the matrix has no block (" +
                 std::to_string(r) + ", " + std::to_string(c) + ")");
        }
        places_.push_back(element[i] <= element[j] ? place : -1 - place);
      }
    }
  }
  colour_begin_.push_back(Elements());
}

std::span<const int> Assembly::Colour(int colour) const {
  const auto at = static_cast<std::size_t>(colour);
  return {order_.begin() + colour_begin_[at], order_.begin() + colour_begin_[at + 1]};
}

// What one thread gathers and computes.
struct Assembly::Buffers {
  explicit Buffers(const KernelRow& row) {
    x.Resize(static_cast<std::size_t>(kBatch * row.energy->dofs));
    p.Resize(static_cast<std::size_t>(kBatch * std::ssize(row.energy->parameters)));
    h.Resize(static_cast<std::size_t>(kBatch * row.outputs));
  }

  AlignedDoubles x, p, h;
};

void Assembly::AddElements(const KernelRow& row, const double* x, const double* p,
                           std::int64_t first, std::int64_t last, Buffers& buffers,
                           double* values) const {
  const int lanes = row.lanes, parameters = static_cast<int>(row.energy->parameters.size());
  const std::int64_t tiles = (last - first + lanes - 1) / lanes;
  // What fills up the last tile is its last element once more, and is not added.
  for (std::int64_t at = 0; at < tiles * lanes; ++at) {
    const std::int64_t source = std::min(first + at, last - 1), lane = at % lanes;
    double* tile_x = buffers.x.Data() + at / lanes * lanes * 3 * size_ + lane;
    double* tile_p = buffers.p.Data() + at / lanes * lanes * parameters + lane;
    for (int i = 0; i < size_; ++i) {
      const double* vertex =
          x + std::int64_t{3} * vertices_[static_cast<std::size_t>(source * size_ + i)];
      for (int k = 0; k < 3; ++k) tile_x[(3 * i + k) * lanes] = vertex[k];
    }
    const double* own = p + std::int64_t{order_[static_cast<std::size_t>(source)]} * parameters;
    for (int k = 0; k < parameters; ++k) tile_p[k * lanes] = own[k];
  }
  row.run(buffers.x.Data(), buffers.p.Data(), buffers.h.Data(), tiles);

  const int dofs = 3 * size_, pairs = PairsOf(size_);
  for (std::int64_t at = 0; at < last - first; ++at) {
    const double* h = buffers.h.Data() + at / lanes * lanes * row.outputs + at % lanes;
    const std::int64_t* place = places_.data() + (first + at) * pairs;
    for (int i = 0; i < size_; ++i) {
      // Rows 3 i to 3 i + 2 of the packed upper triangle, from the diagonal on.
      const double* rows[3];
      for (int k = 0; k < 3; ++k) {
        const int r = 3 * i + k;
        rows[k] = h + (r * dofs - r * (r - 1) / 2 - r) * lanes;
      }
      double* diagonal = values + *place++;
      for (int k = 0; k < 3; ++k) {
        for (int m = 0; m < 3; ++m) {
          diagonal[3 * k + m] += rows[std::min(k, m)][(3 * i + std::max(k, m)) * lanes];
        }
      }
      for (int j = i + 1; j < size_; ++j, ++place) {
        const bool transposed = *place < 0;
        double* block = values + (transposed ? -1 - *place : *place);
        const int across = transposed ? 1 : 3, down = transposed ? 3 : 1;
        for (int k = 0; k < 3; ++k) {
          for (int m = 0; m < 3; ++m) {
            block[across * k + down * m] += rows[k][(3 * j + m) * lanes];
          }
        }
      }
    }
  }
}

void Assembly::Add(const KernelRow& row, std::span<const double> x, std::span<const double> p,
                   int threads, BlockSparse& matrix) const {
  const int dofs = row.energy->dofs;
  if (row.output != "packed" || row.energy->dimension != 3 || dofs != 3 * size_) {
    Refuse(row.name + ": expected a packed row of " + std::to_string(3 * size_) +
           " degrees of freedom");
  }
  const auto expect = [](const char* what, std::size_t found, std::int64_t expected) {
    if (std::cmp_not_equal(found, expected)) {
      Refuse(std::string(what) + " has " + std::to_string(found) + " numbers, expected " +
             std::to_string(expected));
    }
  };
  expect("x", x.size(), std::int64_t{3} * matrix.Vertices());
  expect("p", p.size(), Elements() * std::ssize(row.energy->parameters));
  expect("the matrix", matrix.values.size(), blocks_ * kBlockNumbers);
  if (threads < 1) Refuse(std::to_string(threads) + " threads: expected 1 or more");
#pragma omp parallel num_threads(threads)
  {
    Buffers buffers(row);
    for (int colour = 0; colour < Colours(); ++colour) {
      const std::int64_t begin = colour_begin_[static_cast<std::size_t>(colour)],
                         end = colour_begin_[static_cast<std::size_t>(colour) + 1];
#pragma omp for schedule(static)
      for (std::int64_t first = begin; first < end; first += kBatch) {
        AddElements(row, x.data(), p.data(), first, std::min(first + kBatch, end), buffers,
                    matrix.values.data());
      }
    }
  }
}

}  // namespace definite
