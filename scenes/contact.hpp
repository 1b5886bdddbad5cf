#pragma once

// Which pairs act, and on which side of each other they are.

#include "scenes/model.hpp"

namespace definite::scenes {

// Sides that pairs remember by themselves, for Memory::kPair and for pairs of unknown orientation;
// 0 while out of reach.
struct SideMemory {
  std::vector<int> of_pair;
};

// The pairs in reach at x, as elements of the contact energy with k, eps and side. A pair in reach
// for the first time is remembered.
// Source: the side convention of Shi & Kim 2023, Eq. 25, for unsigned lengths: +1 outside, -1
// penetrating; signed and hybrid lengths are given the orientation.
Elements ContactsAt(const Contacts& contacts, const std::vector<double>& x, SideMemory& memory);

// n.e2 of a pair as its stencil has it: the signed distance between the lines of two edges, or of a
// vertex to a plane; 0 if there is no such plane.
double TripleProduct(const Contacts& contacts, std::size_t pair, const std::vector<double>& x);

// The parameters of the points where two edges cross seen from above; false if they do not.
bool CrossFromAbove(const std::vector<double>& x, const int* edges, double& a, double& b);

}  // namespace definite::scenes
