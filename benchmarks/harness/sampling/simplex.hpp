#pragma once

// Triangles and tetrahedra stretched from a rest shape: F = U diag(s) V^T.

#include <array>
#include <cstddef>
#include <string_view>

#include "benchmarks/harness/sampling/random.hpp"

namespace definite {

using Matrix3 = std::array<std::array<double, 3>, 3>;  // row by row

inline bool IsSimplex(std::string_view stencil) {
  return stencil == "triangle" || stencil == "tetrahedron";
}

// Its vertices have as many coordinates.
inline std::size_t DimensionOf(std::string_view simplex) { return simplex == "triangle" ? 2 : 3; }

inline Matrix3 Product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
  }
  return c;
}

// The rotation by a quaternion, which need not be a unit; about the last axis in two dimensions.
inline Matrix3 TurnOf(std::array<double, 4> q, std::size_t dimension) {
  if (dimension == 2) q[1] = q[2] = 0;
  const auto [w, x, y, z] = q;
  const double s = 2 / (w * w + x * x + y * y + z * z);
  return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

inline Matrix3 DrawTurn(Draws& draws, std::size_t dimension) {
  std::array<double, 4> q;
  for (double& entry : q) entry = draws.Normal();
  return TurnOf(q, dimension);
}

// The vertices of an element whose edges from the first one are columns.
inline void PutVertices(const Matrix3& edges, std::size_t dimension, double* x) {
  for (std::size_t i = 0; i < dimension; ++i) *x++ = 0;
  for (std::size_t vertex = 0; vertex < dimension; ++vertex) {
    for (std::size_t i = 0; i < dimension; ++i) *x++ = edges[i][vertex];
  }
}

// U diag(s) V^T of a rest shape that is a corner of edges 1, U and V drawn.
inline void PutStretched(const std::array<double, 3>& s, Draws& draws, std::size_t dimension,
                         double* x) {
  const Matrix3 u = DrawTurn(draws, dimension), v = DrawTurn(draws, dimension);
  const Matrix3 diagonal = {{{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}}};
  PutVertices(Product(Product(u, diagonal), v), dimension, x);  // the transpose is a turn too
}

// Q (I + spread N), with Q a rotation and N iid N(0,1), of a corner of edges 1.
inline void PutJittered(double spread, Draws& draws, std::size_t dimension, double* x) {
  const Matrix3 turn = DrawTurn(draws, dimension);
  Matrix3 f{};
  for (std::size_t i = 0; i < dimension; ++i) {
    for (std::size_t j = 0; j < dimension; ++j) f[i][j] = (i == j) + spread * draws.Normal();
  }
  PutVertices(Product(turn, f), dimension, x);
}

// 10^-t for t in [0, 4), in + and * alone.
inline double ShortDecades(double t) {
  double power = 1;
  for (; t >= 1; t -= 1) power /= 10;
  const double y = t * 2.302585092994046, z = y / 8;
  double e = 1 - z * (1 - z / 2 * (1 - z / 3 * (1 - z / 4)));
  e *= e;
  e *= e;
  return power * (e * e);
}

}  // namespace definite
