#pragma once

// THE interface: read this file first.
//
// Every Hessian is a sum of modes, H = sum_m lambda[m] v[m] v[m]^T. An energy knows its modes, a
// filter is a map on them or a recipe of its own, and both are written once over a scalar type T.
// The programs see neither: they see two plain tables, AllEnergies() and AllKernels().

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "kernels/core/framed_modes.hpp"

namespace definite {

// H = sum_m lambda[m] v[m] v[m]^T. The v[m] need be neither unit nor orthogonal.
template <class T, int D, int K>
struct Modes {
  static constexpr int kCount = K;
  T lambda[K];
  Vec<T, D> v[K];
};

// Upper triangle of a symmetric matrix, row by row.
template <class T, int D>
struct PackedSym {
  static constexpr int kSize = D * (D + 1) / 2;
  T a[kSize];
};

// Which set of modes. All sets of one energy sum to the same matrix.
enum class Set {
  kFrame,    // of the paper's reduced frame, in a form that is stable everywhere in the domain
  kPrinted,  // of the reduced frame, by the formulas as printed
  kSplit,    // orthogonal in x but for the curvature's
  kExact,    // the one whose sum cancels least
};

// Which part of a set; a filter asks only for what it keeps.
enum class Part {
  kCurvature,  // without what second derivatives of lengths or residuals add: Gauss-Newton's
  kPositive,   // the modes that may be positive
  kAll,
};

// Where a configuration lies, 1 for yes and 0 for no.
template <class T>
struct Classification {
  T active;     // the energy acts: l < eps for a penalty
  T in_domain;  // the energy and its Hessian are defined
  T region;     // which closest feature is in force; 0 where there is one only
};

// A parameter of an energy. Lengths of a configuration times s, and each parameter times
// s^length_power, leave the Hessian unchanged.
struct Parameter {
  std::string_view name;
  double value;  // default
  int length_power;
  std::string_view meaning;
};

// What a row is held to. A filter promises every property but those it lists as exempt, with a
// reason; kernels/PROMISES.txt is the golden list.
enum class Property {
  kFinite,            // no NaN or infinity in the domain
  kPsd,               // -lambda_min(F) / (n u |F|) at most 50
  kAccurate,          // conditioned rounding against its definition in float128 at most 50
  kLanesEqualScalar,  // f64x8 equals f64 bit for bit
  kKeepsPsd,          // F = H where H is PSD already
  kMajorises,         // F - H is PSD
  kRigidMotion,       // F(R x + t) = R F(x) R^T
  kTranslation,       // translations lie in the null space
  kScale,             // lengths in another unit give the same F (Parameter::length_power)
  kRelabelling,       // the numbering of the vertices does not matter
};

struct Exemption {
  Property property;
  std::string_view why;
};

// A sum of modes, in either form: as Modes, or as FramedModes where the vectors have its structure.
template <class R, class T, int D>
inline constexpr bool kIsModes = false;
template <class T, int D, int K>
inline constexpr bool kIsModes<Modes<T, D, K>, T, D> = true;
template <class T, int D, class Stencil, int K, bool kTurning>
inline constexpr bool kIsModes<FramedModes<T, Stencil, K, kTurning>, T, D> =
    3 * Stencil::kVertices == D;
template <class R, class T, int D>
inline constexpr bool kIsSymmetric = kIsModes<R, T, D>;
template <class T, int D>
inline constexpr bool kIsSymmetric<PackedSym<T, D>, T, D> = true;
template <class T, int D, class Stencil, bool kTurning>
inline constexpr bool kIsSymmetric<FramedSum<T, Stencil, kTurning>, T, D> =
    3 * Stencil::kVertices == D;

// An energy psi(x; p) of D degrees of freedom. Value is a cancellation-free form, since a line
// search calls it. Outside the domain, and where inactive, all results are zero.
template <class E, class T>
concept EnergyOver = requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  { E::Name() } -> std::convertible_to<std::string>;
  { E::Source() } -> std::convertible_to<std::string>;
  { E::Stencil::kName } -> std::convertible_to<std::string_view>;
  {std::span<const Parameter>(E::kParameters)};
  { E::Value(x, p) } -> std::same_as<T>;
  { E::Gradient(x, p) } -> std::same_as<Vec<T, E::kDofs>>;
  { E::Classify(x, p) } -> std::same_as<Classification<T>>;
  E::template HessianModes<Set::kExact, Part::kAll>(x, p);
  requires kIsModes<decltype(E::template HessianModes<Set::kFrame, Part::kAll>(x, p)), T, E::kDofs>;
  E::template HessianModes<Set::kFrame, Part::kPositive>(x, p);
};

// A filter gives a symmetric matrix that stands in for the Hessian of any energy it fits: as modes,
// if it can, else packed.
template <class F, class E, class T>
concept FilterOver = EnergyOver<E, T> &&
    requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  { F::kName } -> std::convertible_to<std::string_view>;
  { F::kSource } -> std::convertible_to<std::string_view>;
  {std::span<const Exemption>(F::kExempt)};
  requires kIsSymmetric<decltype(F::template Apply<E>(x, p)), T, E::kDofs>;
};

// One term map^T (sum of modes) map of a Hessian in a reduced frame of F coordinates.
template <class T, int F, int D, int K>
struct FrameTerm {
  Modes<T, F, K> modes;
  T map[F][D];
};

// An energy that shows its reduced frame: a tuple of terms that sum to its Hessian, the curvature,
// if it offers one, being the first mode of the first.
template <class E, class T>
concept WithFrame = requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  std::get<0>(E::FrameTerms(x, p)).map;
};

// An energy that offers the modes of a set.
template <class E, class T, Set kSet>
concept OffersSet = requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  E::template HessianModes<kSet, Part::kAll>(x, p);
};

// An energy that is a penalty of lengths or a sum of squares, and so has a curvature term of its
// own.
template <class E, class T>
concept OffersCurvature = requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  E::template HessianModes<Set::kFrame, Part::kCurvature>(x, p);
};

// An energy that is a penalty of one length: its curvature is one mode.
template <class E, class T>
concept IsPenalty = OffersCurvature<E, T> &&
    requires(const Vec<T, E::kDofs>& x, const Vec<T, E::kParams>& p) {
  requires decltype(E::template HessianModes<Set::kFrame, Part::kCurvature>(x, p))::kCount == 1;
};

// Whether an energy is one of the few that all baselines and outputs are run on: they would give
// other energies rows that say nothing new. Said where the energy is.
template <class E>
inline constexpr bool kStudied = false;

// Whether it shows where the time of an energy goes: the stages of the filters that say so
// (`static constexpr bool kStages = true`) then have rows of their own. Said where the energy is.
template <class E>
inline constexpr bool kStaged = kStudied<E>;
template <class F>
inline constexpr bool kHasStages = requires {
  requires F::kStages;
};

// Whether a filter's matrix is also written in other forms than packed (outputs.hpp). A filter says
// so itself: `static constexpr bool kOutputs = true`.
template <class F>
inline constexpr bool kHasOutputs = requires {
  requires F::kOutputs;
};

// Whether a filter's lanes go two batches at a time (pair.hpp), for one alone would wait for its
// roots and divisions: `static constexpr bool kInPairs = true`.
template <class F>
inline constexpr bool kPaired = requires {
  requires F::kInPairs;
};

// Puts map(lambda) for each lambda. In place: g++ 12 copies modes that are returned by way of
// memory, which took a third of a kernel.
template <class AnyModes, class Map>
DEFINITE_INLINE void MapWeights(AnyModes& modes, Map map) {
#pragma GCC unroll 16
  for (int m = 0; m < AnyModes::kCount; ++m) modes.lambda[m] = map(modes.lambda[m]);
}

// With the vectors written out.
template <class T, int D, int K>
DEFINITE_INLINE const Modes<T, D, K>& Stacked(const Modes<T, D, K>& modes) {
  return modes;
}
template <class T, class Stencil, int K, bool kTurning>
DEFINITE_INLINE auto Stacked(const FramedModes<T, Stencil, K, kTurning>& framed) {
  Modes<T, 3 * Stencil::kVertices, K> modes;
  const auto w = OverVertices<Stencil>(framed.w);
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) {
    modes.lambda[m] = framed.lambda[m];
    modes.v[m] = Kron(w, framed.t[m]);
    if (framed.turns[m] != 0) {
      auto r = framed.r[m];
#pragma GCC unroll 3
      for (int e = 0; e < Stencil::kEdges; ++e) {
        if (e >= framed.turns[m]) r[e] = T(0.0);
      }
      modes.v[m] = AddKron(modes.v[m], OverVertices<Stencil>(r), framed.n);
    }
  }
  return modes;
}

// Calls store(k, value) for each entry of the packed matrix, in order. Entries go straight from
// registers to where they are wanted: a packed matrix on the way cost 15 % (g++ 12, AVX-512).
template <class T, int D, int K, class Store>
DEFINITE_INLINE void ForPacked(const Modes<T, D, K>& modes, Store store) {
  Vec<T, D> scaled[K];
#pragma GCC unroll 16
  for (int m = 0; m < K; ++m) scaled[m] = modes.lambda[m] * modes.v[m];
#pragma GCC unroll 16
  for (int i = 0; i < D; ++i) {
#pragma GCC unroll 16
    for (int j = i; j < D; ++j) {
      T sum = scaled[0][i] * modes.v[0][j];
#pragma GCC unroll 16
      for (int m = 1; m < K; ++m) sum = MulAdd(scaled[m][i], modes.v[m][j], sum);
      store(i * D - i * (i - 1) / 2 + j - i, sum);
    }
  }
}
template <class T, int D, class Store>
DEFINITE_INLINE void ForPacked(const PackedSym<T, D>& h, Store store) {
#pragma GCC unroll 128
  for (int k = 0; k < h.kSize; ++k) store(k, h.a[k]);
}

// A filter's result as a packed matrix.
template <class T, int D, int K>
PackedSym<T, D> ToPacked(const Modes<T, D, K>& modes) {
  PackedSym<T, D> h;
  ForPacked(modes, [&h](int k, const T& value) { h.a[k] = value; });
  return h;
}
template <class T, class Stencil, bool kTurning>
auto ToPacked(const FramedSum<T, Stencil, kTurning>& sum) {
  PackedSym<T, 3 * Stencil::kVertices> h;
  ForPacked(sum, [&h](int k, const T& value) { h.a[k] = value; });
  return h;
}
template <class T, class Stencil, int K, bool kTurning>
auto ToPacked(const FramedModes<T, Stencil, K, kTurning>& modes) {
  return ToPacked(SumOf(modes));
}

// Works on a run of tiles. A tile is W configurations, number by number: entry i of lane w at
// [i * W + w]. W is the row's lanes; a scalar row has W = 1.
using TileFunction = void (*)(const double* x, const double* p, double* out, long tiles);

// A set of modes as plain numbers: `write` gives the weight of each mode and then its vector.
struct ModeTable {
  int count = 0, size = 0;  // modes, and numbers of a vector
  TileFunction write = nullptr;
};

// One term of an energy's reduced frame: modes in the frame coordinates, and the map to these, row
// by row.
struct FrameTable {
  ModeTable modes;
  TileFunction map;  // modes.size x dofs numbers
};

// One for each energy; its functions are scalar (W = 1).
struct EnergyRow {
  std::string name;    // "collision/vertex_face/signed/quadratic"
  std::string source;  // paper and equations
  std::string_view stencil;
  int dofs;
  std::span<const Parameter> parameters;
  // Permutations of the vertices that leave the energy unchanged, `dofs / dimension` entries each.
  std::span<const int> relabellings;
  // Of an energy that is defined on one side only: the permutation that leads there from the other.
  std::span<const int> mirror;
  // The edges that the energy begins with, from vertex to vertex, each from one that an edge before
  // it leads to.
  std::span<const int> tree;
  int dimension;          // coordinates of a vertex
  TileFunction value;     // 1 number
  TileFunction gradient;  // dofs numbers
  TileFunction classify;  // active, in_domain, region
  // Mode sets that claim to be eigensystems, for verification; empty where there is none.
  ModeTable split;                // Set::kSplit in x, the curvature first
  std::vector<FrameTable> frame;  // FrameTerms
};

// Operations on numbers; a fused multiply-add is one. Comparisons, selections, signs and absolute
// values are none.
struct Operations {
  std::int64_t additions = 0, multiplications = 0, fused = 0, divisions = 0, roots = 0, logs = 0;
  std::int64_t stores = 0;  // numbers written

  std::int64_t Arithmetic() const { return additions + multiplications + fused; }
};

// One for each energy x filter x scalar x output.
struct KernelRow {
  std::string name;  // "collision/vertex_face/signed/quadratic/analytic/f64x8"
  const EnergyRow* energy;
  std::string_view filter, source, scalar, output;
  std::span<const Exemption> exempt;
  int lanes;
  int outputs;  // numbers written for each configuration
  TileFunction run;
  // What it does for one configuration, given in scalar layout; null where nobody asks.
  Operations (*count)(const double* x, const double* p) = nullptr;

  bool Promises(Property property) const {
    for (const Exemption& e : exempt) {
      if (e.property == property) return false;
    }
    return true;
  }
};

std::span<const EnergyRow> AllEnergies();
std::span<const KernelRow> AllKernels();
std::span<const KernelRow> AllOutputs();             // those whose output is not packed
const KernelRow* FindKernel(std::string_view name);  // by its full name; null if there is none

}  // namespace definite
