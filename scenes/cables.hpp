#pragma once

// Cables that are pulled against each other: the paper's section 5.2.1 with few segments.
//
// Bundle A runs along x and lies above bundle B, which runs along y. The ends of A move down and
// those of B up, each by `displacement` in 1 s, and are held for 2 s.

#include <string_view>

#include "scenes/scene.hpp"

namespace definite::scenes {

struct Cables {
  // Of the paper, section 5.2.1. Its masses it does not give: they follow from mu.
  double k = 10, eps = 0.09;           // N/m, m
  double rayleigh = 0;                 // s; the paper has 0.006
  int segments = 3, each = 1;          // of a cable; cables in a bundle
  double spacing = 0.12;               // of a bundle, m
  double half_length = 1, gap = 0.11;  // m
  double displacement = 0.35;          // of the ends, m
  double stretch = 0.8;                // springs have stretch k segments / 3
  double rest = 1;         // length of a spring at rest, in that at the start: pre-tension below 1
  double bending = 0;      // in k times a square metre
  double gravity = 0;      // m/s^2
  double mass_spread = 0;  // masses times exp(uniform in +- this)
  double yaw = 0.3, offset = 0.2, noise = 0;  // at random: radians, metres, metres
  bool b_is_fixed = false;                    // else both bundles are free
  bool within_bundles = false;                // contacts there too
  Memory memory = Memory::kNone;
  Solver solver = Solver::kLdlt;
  int iterations = 1;
  bool line_search = false;
};

// Terms that cables may have: what a scene has can be removed, and what it has not, added.
std::vector<Change> ChangesOf(const Cables& cables);

// A trial of a case, its change applied.
Trial MakeCables(Cables cables, const Case& c, Draws& draws);

}  // namespace definite::scenes
