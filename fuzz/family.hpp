#pragma once

// Families of degenerate configurations. A family turns genes into a configuration; where the genes
// come from (a counter-based generator, a fuzzer's bytes, a shrinker) is not its business.

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "benchmarks/harness/sampling/distribution.hpp"

namespace definite::fuzz {

// Everything a configuration of a family is made of.
struct Genes {
  double delta;   // how degenerate: 0, or between 1e-16 and 1
  bool negative;  // the other sign, where there are two
  enum Pose {
    kAxes,    // as it was built: edges in the plane z = 0, one along x, nothing rounded
    kDyadic,  // coordinates rounded to multiples of 2^-20 of the largest
    kTurned,  // turned at random, which rounds them all
  } pose;
  std::array<double, 12> u;  // in (0,1): the rest of the shape

  // For what delta divides.
  double PositiveDelta() const { return delta > 0 ? delta : 1e-16; }
};

inline constexpr int kDecades = 17;  // of delta, the last of them 0

// Log-uniform delta, but 0 in one of 17; or, of one decade, 10^-(decade+1) to 10^-decade (16: 0).
Genes DrawGenes(Draws& draws, std::optional<int> decade = std::nullopt);

// Two primitives in contact, a strand or a simplex, before they are posed: edges e0 and e1 in a
// plane, with an angle between them. As the stencils have it, with n the plane's normal:
//   vertex_face   e2 = a e0 + b e1 + l n     (e0 = x1-x2, e1 = x3-x2, e2 = x0-x2)
//   edge_edge     e2 = a e0 - b e1 + l n     (e0 = x1-x0, e1 = x3-x2, e2 = x2-x0)
//   vertex_edge   x0 - x1 = a e0 + l n       (e0 = x2-x1)
//   vertex_vertex x1 - x0 = l n
//   corner        e0 = x0-x1, e1 = x2-x1: a strand bent at x1
//   torsion       x2-x1 = e0, x0-x1 = e1, and x3-x2 as long, with the angle at x1, turned about e0
//   segment       x1 - x0 = e0
struct Shape {
  double length0, length1;  // of the edges
  double sine;              // of the angle between them
  bool obtuse;
  double a, b;  // the foot point, in edges
  double l, eps;
  double half_twist;                // tangent of half the angle from x0 to x3 about e0
  double unit;                      // all lengths times this
  std::array<double, 3> shift;      // added to every vertex, in edges of length 1
  std::array<double, 3> stretches;  // the last one at will negative; a triangle has the outer two
  double rest_height;               // of the last vertex over the others
};

// Nothing degenerate: edges from 1/2 to 2, an angle of 30 to 150 degrees, the foot point inside,
// |l| below eps. Where an energy has a side, Pose leaves it open for one half, and draws it for the
// other.
Shape OrdinaryShape(const Genes& genes);

// The configuration: dofs numbers x and a number p for each parameter.
void Pose(const Shape& shape, const Genes& genes, const DrawTarget& target, double* x, double* p);

// What a file in families/ defines: a name, what delta is, what to do where it is small, the
// stencils it has a meaning for, and what it makes of an ordinary shape.
template <class F>
concept FamilyType = requires(const Genes& genes, Shape& shape) {
  { F::kName } -> std::convertible_to<std::string_view>;
  { F::kMeaning } -> std::convertible_to<std::string_view>;
  { F::kRemedy } -> std::convertible_to<std::string_view>;
  { F::kStencils } -> std::convertible_to<std::span<const std::string_view>>;
  F::Deform(genes, shape);
};

struct Family {
  std::string_view name, meaning, remedy;
  std::span<const std::string_view> stencils;
  void (*deform)(const Genes& genes, Shape& shape);

  bool Has(std::string_view stencil) const;
};

// In alphabetical order of their files.
std::span<const Family> AllFamilies();

// The distribution "fuzz/NAME" of a family, or "fuzz/NAME/DECADE" of one decade of its delta; null
// if there is no such.
const Distribution* FindFamily(std::string_view name);

// Those of the distribution "fuzz/NAME", or "fuzz/NAME/DECADE".
Genes GenesAt(const Family& family, std::optional<int> decade, std::uint64_t seed,
              std::uint64_t index);

// What genes of a family make.
void Make(const Family& family, const Genes& genes, const DrawTarget& target, double* x, double* p);

template <FamilyType F>
constexpr Family MakeFamily() {
  return {F::kName, F::kMeaning, F::kRemedy, F::kStencils, F::Deform};
}

inline constexpr std::string_view kFaces[] = {"vertex_face"}, kEdgePairs[] = {"edge_edge"},
                                  kPairs[] = {"edge_edge", "vertex_face"},
                                  kContacts[] = {"edge_edge", "vertex_edge", "vertex_face"},
                                  kAllContacts[] = {"edge_edge", "vertex_edge", "vertex_face",
                                                    "vertex_vertex"},
                                  kStrands[] = {"corner", "torsion"}, kTwisted[] = {"torsion"},
                                  kSprings[] = {"segment"},
                                  kSimplices[] = {"tetrahedron", "triangle"},
                                  kTetrahedra[] = {"tetrahedron"},
                                  kEverything[] = {"corner",      "edge_edge",    "segment",
                                                   "tetrahedron", "triangle",     "vertex_edge",
                                                   "vertex_face", "vertex_vertex"};

}  // namespace definite::fuzz

// Stands last in each file of families/; CMake finds it there and adds a row to AllFamilies().
#define DEFINITE_FAMILY(Type) \
  static_assert(::definite::fuzz::FamilyType<::definite::fuzz::families::Type>)
