#pragma once

#include <string_view>

#include "reference/filters/analytic.hpp"

namespace definite::reference {

// The same matrix by blocks over principal stretches (Stomakhin et al. 2012).
struct Stomakhin : Analytic {
  static constexpr std::string_view kName = "stomakhin";
};

DEFINITE_REFERENCE_FILTER(Stomakhin);

}  // namespace definite::reference
