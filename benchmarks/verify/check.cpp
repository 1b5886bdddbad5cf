#include "benchmarks/verify/check.hpp"

#include <cmath>

namespace definite::verify {

std::span<const Check> AllChecks() {
  static const std::vector<Check> checks = [] {
    std::vector<Check> all;
    for (const auto group :
         {DerivativeChecks, EigensystemChecks, FrameChecks, IdentityChecks, RowChecks}) {
      const std::vector<Check> part = group();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return checks;
}

std::optional<Finding> Worse(const std::optional<Finding>& a, const std::optional<Finding>& b) {
  if (!a || !b) return a ? a : b;
  if (std::isnan(a->violation)) return a;
  return b->violation <= a->violation ? a : b;
}

bool AppliesToAll(const Subject&) { return true; }
bool HasFrame(const Subject& subject) { return !subject.energy->frame.empty(); }

}  // namespace definite::verify
