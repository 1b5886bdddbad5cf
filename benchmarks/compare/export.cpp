#include "benchmarks/compare/export.hpp"

#include <fmt/format.h>

#include "benchmarks/compare/compare.hpp"

namespace definite {

nlohmann::ordered_json ToCustomSmallerIsBetter(const nlohmann::ordered_json& result) {
  auto list = nlohmann::ordered_json::array();
  for (const Timed& timed : TimesOf(result)) {
    const auto estimate = EstimateMedian(timed.ns);
    list.push_back(
        {{"name", timed.key},
         {"unit", "ns"},
         {"value", estimate->median},
         {"range", fmt::format("± {:.3g}", 0.5 * (estimate->high - estimate->low))},
         {"extra",
          fmt::format("{} rounds, 95 % interval {:.4g} to {:.4g} ns, minimum {:.4g} ns",
                      timed.ns.size(), estimate->low, estimate->high, estimate->minimum)}});
  }
  return list;
}

}  // namespace definite
