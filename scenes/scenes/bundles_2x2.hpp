#pragma once

#include "scenes/bundles.hpp"

namespace definite::scenes {

struct Bundles2x2 : Bundles<2> {
  static constexpr std::string_view kName = "bundles_2x2";
  static constexpr std::string_view kUses =
      "2 + 2 cables of 3 segments, 24 degrees of freedom: edge-edge contact, and springs that "
      "pull";
};

}  // namespace definite::scenes

DEFINITE_SCENE(Bundles2x2);
