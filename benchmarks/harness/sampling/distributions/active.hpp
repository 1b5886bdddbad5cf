#pragma once

#include <array>
#include <cmath>

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/sampling/simplex.hpp"

namespace definite::distributions {

// Contact-like pairs: edges of random shape, closest points in the interior of the triangle or of
// both edges, and a signed length l uniform in (-eps, eps). Conventions as in the stencils, x2 at
// the origin, n = e0 x e1 / |e0 x e1|, l = n.e2:
//   vertex_face  e0 = x1-x2, e1 = x3-x2, e2 = x0-x2 = beta e0 + gamma e1 + l n
//   vertex_edge  x0-x1 = beta e + l m, e = x2-x1, m a unit vector normal to e
//   vertex_vertex  x1-x0 = l m
//   corner       three iid N(0,1) vertices: a strand is always active
//   torsion      four
//   segment      two
//   triangle, tetrahedron  F = Q (I + N/4), Q a rotation, N iid N(0,1): as in a simulation that
//                moves a lot; the rest shape is a corner of edges 1
//   edge_edge    e0 = x1-x0, e1 = x3-x2, e2 = x2-x0 = a e0 - b e1 + l n
struct Active {
  static constexpr std::string_view kName = "active";
  static constexpr std::string_view kDescription =
      "contact-like: closest points interior, signed length uniform in (-eps, eps), eps = 0.1";
  static constexpr double kEps = 0.1;
  static constexpr ParameterValue kParameters[] = {{"k", 1}, {"eps", kEps}, {"side", 0}};

  static bool Supports(std::string_view stencil) {
    return stencil == "vertex_face" || stencil == "edge_edge" || stencil == "vertex_edge" ||
           stencil == "vertex_vertex" || stencil == "corner" || stencil == "segment" ||
           stencil == "torsion" || IsSimplex(stencil);
  }

  static void DrawCoordinates(const DrawTarget& target, Draws& draws, double* x) {
    if (target.stencil == "vertex_face") {
      DrawVertexFace(draws, x);
    } else if (target.stencil == "edge_edge") {
      DrawEdgeEdge(draws, x);
    } else if (target.stencil == "vertex_edge") {
      DrawVertexEdge(draws, x);
    } else if (target.stencil == "vertex_vertex") {
      DrawVertexVertex(draws, x);
    } else if (IsSimplex(target.stencil)) {
      PutJittered(0.25, draws, DimensionOf(target.stencil), x);
    } else {
      DrawStrand(target, draws, x);
    }
  }

 private:
  using Vec3 = std::array<double, 3>;

  static Vec3 NormalPoint(Draws& draws) {
    const double x = draws.Normal(), y = draws.Normal(), z = draws.Normal();
    return {x, y, z};
  }

  static Vec3 Difference(const Vec3& v, const Vec3& w) {
    return {v[0] - w[0], v[1] - w[1], v[2] - w[2]};
  }

  // s e0 + t e1 + l n, with l drawn.
  static Vec3 Offset(Draws& draws, const Vec3& e0, const Vec3& e1, double s, double t) {
    const Vec3 cross = {e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                        e0[0] * e1[1] - e0[1] * e1[0]};
    const double l = kEps * (2 * draws.OpenUniform() - 1);
    const double scale =
        l / std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    Vec3 sum;
    for (std::size_t i = 0; i < 3; ++i) sum[i] = s * e0[i] + t * e1[i] + scale * cross[i];
    return sum;
  }

  static void DrawVertexFace(Draws& draws, double* x) {
    const Vec3 v1 = NormalPoint(draws), v2 = NormalPoint(draws), v3 = NormalPoint(draws);
    const Vec3 e0 = Difference(v1, v2), e1 = Difference(v3, v2);
    double beta, gamma;
    do {  // uniform in the open triangle
      beta = draws.OpenUniform();
      gamma = draws.OpenUniform();
    } while (beta + gamma >= 1);
    const Vec3 e2 = Offset(draws, e0, e1, beta, gamma);
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = e2[i];
      x[3 + i] = e0[i];
      x[6 + i] = 0;
      x[9 + i] = e1[i];
    }
  }

  static void DrawVertexEdge(Draws& draws, double* x) {
    const Vec3 v1 = NormalPoint(draws), v2 = NormalPoint(draws), other = NormalPoint(draws);
    const Vec3 e = Difference(v2, v1);
    const Vec3 d = Offset(draws, e, other, draws.OpenUniform(), 0);
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = d[i];
      x[3 + i] = 0;
      x[6 + i] = e[i];
    }
  }

  static void DrawVertexVertex(Draws& draws, double* x) {
    const Vec3 v = NormalPoint(draws), w = NormalPoint(draws);
    const Vec3 d = Offset(draws, v, w, 0, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = 0;
      x[3 + i] = d[i];
    }
  }

  static void DrawStrand(const DrawTarget& target, Draws& draws, double* x) {
    for (int i = 0; i < target.dofs; ++i) x[i] = draws.Normal();
  }

  static void DrawEdgeEdge(Draws& draws, double* x) {
    const Vec3 v0 = NormalPoint(draws), v1 = NormalPoint(draws);
    const Vec3 v2 = NormalPoint(draws), v3 = NormalPoint(draws);
    const Vec3 e0 = Difference(v1, v0), e1 = Difference(v3, v2);
    const double a = draws.OpenUniform();
    const double b = draws.OpenUniform();
    const Vec3 e2 = Offset(draws, e0, e1, a, -b);
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = -e2[i];
      x[3 + i] = e0[i] - e2[i];
      x[6 + i] = 0;
      x[9 + i] = e1[i];
    }
  }
};

}  // namespace definite::distributions

DEFINITE_DISTRIBUTION(Active);
