#include "benchmarks/harness/sampling/distribution.hpp"

#include <algorithm>

namespace definite {

const Distribution* FindDistribution(std::string_view name) {
  for (const Distribution& distribution : AllDistributions()) {
    if (distribution.name == name) return &distribution;
  }
  return nullptr;
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
