#pragma once

#include <string_view>

#include "reference/filters/numeric.hpp"

namespace definite::reference {

// The same matrix by whatever an energy knows of its spectrum.
struct Nearest : Numeric {
  static constexpr std::string_view kName = "nearest";
};

DEFINITE_REFERENCE_FILTER(Nearest);

}  // namespace definite::reference
