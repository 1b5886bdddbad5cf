#pragma once

// What a number of failing runs says: intervals of 95 %, and an exact test.

#include <cstdint>
#include <vector>

namespace definite::scenes {

struct Interval {
  double low, high;
};

// Of a fraction, `of` > 0. Source: Wilson 1927.
Interval WilsonInterval(std::uint64_t count, std::uint64_t of);

// Of the difference of two fractions, second minus first, of independent runs. Source: Newcombe
// 1998, Statistics in Medicine 17:873-890, method 10.
Interval DifferenceInterval(std::uint64_t first, std::uint64_t of_first, std::uint64_t second,
                            std::uint64_t of_second);

// The same of pairs: run i of both began alike. Source: Newcombe 1998, Statistics in Medicine
// 17:2635-2650, method 10.
Interval PairedInterval(const std::vector<bool>& first, const std::vector<bool>& second);

// Of values in any order; the upper one of an even number, 0 of none.
double MedianOf(std::vector<double> values);

// Two-sided p value that two fractions are the same. Source: Fisher's exact test.
double FisherTest(std::uint64_t first, std::uint64_t of_first, std::uint64_t second,
                  std::uint64_t of_second);

}  // namespace definite::scenes
