#include "benchmarks/harness/sampling/distribution.hpp"

#include <algorithm>
#include <map>

#include "benchmarks/harness/sampling/recorded.hpp"
#include "fuzz/family.hpp"

namespace definite {

namespace {

Distribution OfFile(const std::string& path) {
  const auto recorded = std::make_shared<const Recorded>(ReadRecorded(path));
  return {path, "configurations on record",
          [recorded](std::string_view stencil) { return stencil == recorded->stencil; },
          [recorded](const DrawTarget& target, std::uint64_t, std::uint64_t index, double* x,
                     double* p) { recorded->Take(target, index, x, p); },
          recorded};
}

}  // namespace

const Distribution* FindDistribution(std::string_view name) {
  for (const Distribution& distribution : AllDistributions()) {
    if (distribution.name == name) return &distribution;
  }
  if (const Distribution* family = fuzz::FindFamily(name)) return family;
  if (!IsRecorded(name)) return nullptr;
  static std::map<std::string, Distribution, std::less<>> files;
  const auto at = files.find(name);
  if (at != files.end()) return &at->second;
  const std::string path(name);
  return &files.emplace(path, OfFile(path)).first->second;
}

bool HasParameter(const EnergyRow& energy, std::string_view name) {
  return std::ranges::find(energy.parameters, name, &Parameter::name) != energy.parameters.end();
}

void OverrideParameters(std::span<const Parameter> parameters,
                        std::span<const ParameterValue> overrides, double* p) {
  for (const Parameter& parameter : parameters) {
    for (const ParameterValue& replacement : overrides) {
      if (replacement.name == parameter.name) *p = replacement.value;
    }
    ++p;
  }
}

void FillParameters(std::span<const Parameter> parameters,
                    std::span<const ParameterValue> overrides, double* p) {
  std::ranges::transform(parameters, p, &Parameter::value);
  OverrideParameters(parameters, overrides, p);
}

}  // namespace definite
