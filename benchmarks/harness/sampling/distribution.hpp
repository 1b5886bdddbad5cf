#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "benchmarks/harness/sampling/random.hpp"
#include "kernels/kernel.hpp"

namespace definite {

// A parameter that is set, whatever the energy's default.
struct ParameterValue {
  std::string_view name;
  double value;
};

// What a distribution has to know of an energy.
struct DrawTarget {
  std::string_view stencil;  // "vertex_face", "edge_edge", ...
  int dofs;
  std::span<const Parameter> parameters;  // with the energy's own values
};

struct Recorded;

// A way to draw configurations. A configuration is named by (distribution, seed, index).
struct Distribution {
  std::string name, description;
  std::function<bool(std::string_view stencil)> supports;
  // Fills x (dofs numbers) and p (one number for each parameter). Only for supported stencils.
  std::function<void(const DrawTarget& target, std::uint64_t seed, std::uint64_t index, double* x,
                     double* p)>
      draw;
  // The file they come from (recorded.hpp), whatever the seed; null if they are drawn.
  std::shared_ptr<const Recorded> recorded = nullptr;
};

// By name, in alphabetical order of their files.
std::span<const Distribution> AllDistributions();

// One of these; or that of a degenerate family (fuzz/family.hpp); or of a file, by its path, which is
// read at the first call. Null if there is none of this name; throws RecordedError if the file is not
// as it should be. Not thread safe.
const Distribution* FindDistribution(std::string_view name);

// What a file in distributions/ defines: a name, the stencils it can draw, the parameters it
// overrides, and the coordinates.
template <class D>
concept DistributionType = requires(const DrawTarget& target, Draws& draws, double* x) {
  { D::kName } -> std::convertible_to<std::string_view>;
  { D::kDescription } -> std::convertible_to<std::string_view>;
  { D::kParameters } -> std::convertible_to<std::span<const ParameterValue>>;
  { D::Supports(target.stencil) } -> std::same_as<bool>;
  D::DrawCoordinates(target, draws, x);
};

bool HasParameter(const EnergyRow& energy, std::string_view name);

// Those of p that have a value in `overrides` get it.
void OverrideParameters(std::span<const Parameter> parameters,
                        std::span<const ParameterValue> overrides, double* p);

// p = the energy's parameters, with those of the same name in `overrides` replaced.
void FillParameters(std::span<const Parameter> parameters,
                    std::span<const ParameterValue> overrides, double* p);

template <DistributionType D>
Distribution MakeDistribution() {
  return {
      std::string(D::kName), std::string(D::kDescription), D::Supports,
      [](const DrawTarget& target, std::uint64_t seed, std::uint64_t index, double* x, double* p) {
        constexpr std::uint64_t kStream = StreamId(D::kName);
        Draws draws(kStream, seed, index);
        D::DrawCoordinates(target, draws, x);
        FillParameters(target.parameters, D::kParameters, p);
      }};
}

}  // namespace definite

// Stands last in each file of distributions/; CMake finds it there and adds a row to
// AllDistributions().
#define DEFINITE_DISTRIBUTION(Type) \
  static_assert(::definite::DistributionType<::definite::distributions::Type>)
