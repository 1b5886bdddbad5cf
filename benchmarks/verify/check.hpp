#pragma once

// The checks of `definite verify`: what the paper's Matlab scripts did, and further. A check looks
// at one configuration and tells by how much it misses its bound.

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "benchmarks/verify/case.hpp"

namespace definite::verify {

struct Finding {
  double violation;                // in units of the bound: above 1, or NaN, the check fails
  const KernelRow* row = nullptr;  // which it is about, if one of the rows
};

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Check {
  std::string_view name;
  std::string_view says;  // what holds where it passes
  bool (*applies)(const Subject& subject);
  // Nothing where the check says nothing of the configuration, which is in the domain and active.
  std::optional<Finding> (*find)(Case& at);
  bool everywhere = false;  // also where the kernel does not act
};

std::span<const Check> AllChecks();

// By group, in the order of AllChecks.
std::vector<Check> DerivativeChecks();   // value, gradient and Hessian belong together
std::vector<Check> EigensystemChecks();  // modes are eigenpairs, and all of them
std::vector<Check> FrameChecks();        // the change of basis, Eq. 17; inertia
std::vector<Check> IdentityChecks();     // energies and filters that are the same by theory
std::vector<Check> RowChecks();          // each row against its definition

// The worse of both; NaN is the worst there is.
std::optional<Finding> Worse(const std::optional<Finding>& a, const std::optional<Finding>& b);

// For Check::applies.
bool AppliesToAll(const Subject& subject);
bool HasFrame(const Subject& subject);

}  // namespace definite::verify
