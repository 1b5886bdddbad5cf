#pragma once

// Known bad filters, kept to see that the hunt finds what is wrong with each.

#include <optional>
#include <span>
#include <string_view>

#include "fuzz/findings.hpp"

namespace definite::fuzz {

struct Exhibit {
  std::string_view name, mistake;
  std::string_view caught_by;  // the promise that it must be seen to break, or "crash"
  KernelRow row;               // promises everything
};

std::span<const Exhibit> Exhibits();

// Hunts until the mistake is found; null if it escapes.
std::optional<Finding> Catch(const Exhibit& exhibit);

}  // namespace definite::fuzz
