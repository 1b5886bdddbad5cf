#pragma once

#include <boost/multiprecision/float128.hpp>

namespace definite::reference {

// The scalar of the truth: 113 bits, u = 2^-113, range 1e+-4932, so that squares and cubes of any
// double stay finite and normal. Boost's wrapper, because g++ 12 says
// std::numeric_limits<__float128>::epsilon() == 0. Its max() and min() do not compile under
// -std=c++20 with g++ 12 (they do under gnu++20); epsilon() and quiet_NaN() do.
using Quad = boost::multiprecision::float128;

}  // namespace definite::reference
