// The roots of the secular equation against bisection in float128.

#include "kernels/core/secular.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/float128.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/quad.hpp"

namespace definite {
namespace {

using reference::Quad;

constexpr double kBound = 100;  // of an error in units of u

// The root right of pole k as its offset from a pole, k or the next, by bisection: first halving in
// ratio, so that a root next to that pole is found to full relative accuracy too.
template <int N>
Quad OffsetFrom(const SecularEquation<double, N>& e, int k, int origin) {
  const int direction = origin == k ? 1 : -1;
  Quad low = 1e-300, high = 0;
  if (k + 1 < N) {
    high = Quad(e.pole[k + 1]) - e.pole[k];
  } else {
    for (double w : e.weight) high += 2 * Quad(w);
  }
  for (int step = 0; step < 180; ++step) {
    const Quad x = high > 4 * low ? sqrt(low * high) : (low + high) / 2;
    Quad f = 1;
    for (int i = 0; i < N; ++i) {
      f += e.weight[i] / ((Quad(e.pole[i]) - e.pole[origin]) - direction * x);
    }
    (direction * f < 0 ? low : high) = x;
  }
  return direction * low;
}

// The sum of mu y y^T over the roots as upper triangle, y the unit vectors z_i / (d_i - mu). Where
// poles meet two of them span the right plane and need not be orthogonal: from the last root down
// each is made so.
template <int N, int K, class Distance>
std::vector<Quad> Projected(const SecularEquation<double, N>& e, const Quad (&value)[K],
                            Distance distance) {
  std::vector<Quad> sum(N * (N + 1) / 2);
  Quad y[K][N];
  for (int m = K - 1; m >= 0; --m) {
    for (int i = 0; i < N; ++i) y[m][i] = sqrt(Quad(e.weight[i])) / distance(m, i);
    for (int other = K - 1; other > m; --other) {
      Quad along = 0;
      for (int i = 0; i < N; ++i) along += y[m][i] * y[other][i];
      for (int i = 0; i < N; ++i) y[m][i] -= along * y[other][i];
    }
    Quad squared = 0;
    for (Quad& v : y[m]) squared += v * v;
    for (Quad& v : y[m]) v /= sqrt(squared);
    std::size_t at = 0;
    for (int i = 0; i < N; ++i) {
      for (int j = i; j < N; ++j) sum[at++] += value[m] * y[m][i] * y[m][j];
    }
  }
  return sum;
}

// From the middles of the brackets.
template <int kFirst, int K, class T, int N>
SecularRoots<T, N, K> RootsOf(const SecularEquation<T, N>& e) {
  T near[K];
  for (int m = 0; m < K; ++m) {
    const int k = kFirst + m;
    near[m] = T(0.5) * (e.pole[k] + (k + 1 < N ? e.pole[k + 1] : e.Bound()));
  }
  return e.template Roots<kFirst, K>(near);
}

// What the roots and distances are for: the relative error of the projection made of them, in
// units of u.
template <int N, int K, int kFirst = N - K>
double ErrorOf(const SecularEquation<double, N>& e) {
  const auto roots = RootsOf<kFirst, K>(e);
  Quad value[K], exact[K], offset[K];
  int origin[K];
  for (int m = 0; m < K; ++m) {
    const int k = kFirst + m;
    origin[m] = k;
    offset[m] = OffsetFrom(e, k, k);
    if (k + 1 < N) {
      const Quad from_right = OffsetFrom(e, k, k + 1);
      if (-from_right < offset[m]) origin[m] = k + 1, offset[m] = from_right;
    }
    value[m] = roots.root[m].value;
    exact[m] = e.pole[origin[m]] + offset[m];
  }
  const auto found =
      Projected<N, K>(e, value, [&](int m, int i) { return Quad(roots.root[m].to_pole[i]); });
  const auto expected = Projected<N, K>(e, exact, [&](int m, int i) {
    return Quad((Quad(e.pole[i]) - e.pole[origin[m]]) - offset[m]);
  });
  Quad distance = 0, norm = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    distance += (found[k] - expected[k]) * (found[k] - expected[k]);
    norm += expected[k] * expected[k];
  }
  return static_cast<double>(sqrt(distance / norm)) / (std::numeric_limits<double>::epsilon() / 2);
}

// Poles -a, -b, 0, c, d with weights, each of its own order of magnitude down to 10^-decades.
SecularEquation<double, 5> Drawn(std::mt19937_64& random, double decades, double weight_decades) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto size = [&](double least) { return std::pow(10, -least * unit(random)); };
  SecularEquation<double, 5> e;
  double p[4];
  for (double& v : p) v = size(decades);
  std::sort(p, p + 2);
  std::sort(p + 2, p + 4);
  e.pole[0] = -p[1], e.pole[1] = -p[0], e.pole[2] = 0, e.pole[3] = p[2], e.pole[4] = p[3];
  for (double& w : e.weight) w = size(weight_decades);
  return e;
}

TEST(SecularEquation, GivesTheProjectionToRounding) {
  std::mt19937_64 random(1);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto e = Drawn(random, 2, 2);
    worst = std::max({worst, ErrorOf<5, 3>(e), ErrorOf<5, 2, 0>(e)});
  }
  EXPECT_LT(worst, kBound);
}

TEST(SecularEquation, AlsoWhereWeightsAreTiny) {
  std::mt19937_64 random(2);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto e = Drawn(random, 1, 34);
    worst = std::max({worst, ErrorOf<5, 3>(e), ErrorOf<5, 2, 0>(e)});
  }
  EXPECT_LT(worst, kBound);
}

TEST(SecularEquation, AlsoWherePolesMeet) {
  std::mt19937_64 random(3);
  double worst = 0;
  for (double apart : {1e-3, 1e-8, 1e-12, 0x1p-50}) {
    for (int i = 0; i < 200; ++i) {
      SecularEquation<double, 5> e = Drawn(random, 1, 20);
      e.pole[3] = e.pole[4] * (1 - apart);
      e.pole[1] = e.pole[0] * (1 - apart);
      worst = std::max({worst, ErrorOf<5, 3>(e), ErrorOf<5, 2, 0>(e)});
    }
  }
  EXPECT_LT(worst, kBound);
}

TEST(SecularEquation, HoldsInThreeDimensions) {
  std::mt19937_64 random(4);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto five = Drawn(random, 2, 10);
    const SecularEquation<double, 3> e{{five.pole[1], 0, five.pole[3]},
                                       {five.weight[1], five.weight[2], five.weight[3]}};
    worst = std::max(worst, ErrorOf<3, 2>(e));
  }
  EXPECT_LT(worst, kBound);
}

// Lanes that need more steps must not move those that have settled.
TEST(SecularEquation, HasTheSameRootsOnLanes) {
  std::mt19937_64 random(5);
  using L = Lanes<double, kNativeLanes>;
  for (int i = 0; i < 200; ++i) {
    SecularEquation<L, 5> lanes;
    SecularEquation<double, 5> scalar[kNativeLanes];
    for (int w = 0; w < kNativeLanes; ++w) {
      scalar[w] = Drawn(random, 1 + w % 3, w % 2 ? 30 : 1);
      for (int k = 0; k < 5; ++k) {
        lanes.pole[k].lane[w] = scalar[w].pole[k];
        lanes.weight[k].lane[w] = scalar[w].weight[k];
      }
    }
    const auto roots = RootsOf<2, 3>(lanes);
    for (int w = 0; w < kNativeLanes; ++w) {
      const auto expected = RootsOf<2, 3>(scalar[w]);
      for (int m = 0; m < 3; ++m) {
        EXPECT_EQ(roots.root[m].value.lane[w], expected.root[m].value);
        for (int k = 0; k < 5; ++k) {
          EXPECT_EQ(roots.root[m].to_pole[k].lane[w], expected.root[m].to_pole[k]);
        }
      }
    }
  }
}

TEST(SecularEquation, PassesNanOn) {
  SecularEquation<double, 5> e{{-2, -1, 0, 1, 2}, {1, 1, std::nan(""), 1, 1}};
  for (const auto& root : RootsOf<2, 3>(e).root) EXPECT_TRUE(std::isnan(root.value));
}

}  // namespace
}  // namespace definite
