#include "benchmarks/harness/sampling/distribution.hpp"

namespace definite {

const Distribution* FindDistribution(std::string_view name) {
  for (const Distribution& distribution : AllDistributions()) {
    if (distribution.name == name) return &distribution;
  }
  return nullptr;
}

void FillParameters(std::span<const Parameter> parameters,
                    std::span<const ParameterValue> overrides, double* p) {
  for (const Parameter& parameter : parameters) {
    *p = parameter.value;
    for (const ParameterValue& replacement : overrides) {
      if (replacement.name == parameter.name) *p = replacement.value;
    }
    ++p;
  }
}

}  // namespace definite
