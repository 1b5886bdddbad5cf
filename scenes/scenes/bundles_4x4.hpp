#pragma once

#include "scenes/bundles.hpp"

namespace definite::scenes {

struct Bundles4x4 : Bundles<4> {
  static constexpr std::string_view kName = "bundles_4x4";
  static constexpr std::string_view kUses =
      "4 + 4 cables of 3 segments, 48 degrees of freedom: edge-edge contact, and springs that "
      "pull";
};

}  // namespace definite::scenes

DEFINITE_SCENE(Bundles4x4);
