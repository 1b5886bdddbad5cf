#include "benchmarks/plans/plan.hpp"

namespace definite {

std::span<const Plan> AllPlans() {
  static const Plan kPlans[] = {ShiKim2023(), CollisionAccuracy(), FirstStudy()};
  return kPlans;
}

}  // namespace definite
