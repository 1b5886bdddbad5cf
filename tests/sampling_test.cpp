#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "benchmarks/harness/sampling/distribution.hpp"
#include "benchmarks/harness/sampling/random.hpp"

namespace definite {
namespace {

using Configuration = std::array<double, 12>;

Configuration Draw(std::string_view distribution, std::string_view stencil, std::uint64_t seed,
                   std::uint64_t index) {
  Configuration x;
  FindDistribution(distribution)->draw({stencil, 12, {}}, seed, index, x.data(), nullptr);
  return x;
}

std::array<double, 4> DrawParameters(std::string_view distribution) {
  constexpr Parameter kParameters[] = {
      {"eps", 7, 1, ""}, {"eta", 8, 2, ""}, {"k", 9, 0, ""}, {"side", 10, 0, ""}};
  Configuration x;
  std::array<double, 4> p;
  FindDistribution(distribution)->draw({"vertex_face", 12, kParameters}, 42, 0, x.data(), p.data());
  return p;
}

// The Kolmogorov-Smirnov statistic times sqrt(n); above 1.95 in 0.1 % of true samples.
template <class Cdf>
double KolmogorovSmirnov(std::vector<double> sample, Cdf cdf) {
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  double distance = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double below = static_cast<double>(i) / n, f = cdf(sample[i]);
    distance = std::max({distance, f - below, below + 1 / n - f});
  }
  return distance * std::sqrt(n);
}
constexpr double kKolmogorovBound = 1.95;

double UniformCdf(double x) { return x; }
double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// The sample's mean of x^power in standard errors from `expected`.
double MomentDeviation(const std::vector<double>& sample, int power, double expected) {
  const double n = static_cast<double>(sample.size());
  double sum = 0, squares = 0;
  for (const double x : sample) {
    const double term = std::pow(x, power);
    sum += term;
    squares += term * term;
  }
  const double mean = sum / n;
  return std::fabs(mean - expected) / std::sqrt((squares / n - mean * mean) / n);
}

std::vector<double> Coordinates(std::string_view distribution) {
  std::vector<double> sample;
  for (std::uint64_t index = 0; index < 20000; ++index) {
    for (const double x : Draw(distribution, "vertex_face", 42, index)) sample.push_back(x);
  }
  return sample;
}

TEST(Random, IsPhiloxOfTheSeedTheStreamAndTheIndex) {
  // The first line of Random123's known answers: counter 0, key 0.
  Draws zero(0, 0, 0);
  EXPECT_EQ(zero.Bits(), 0x16554d9eca36314cU);
  EXPECT_EQ(zero.Bits(), 0xdb20fe9d672d0fdcU);
  EXPECT_EQ(zero.Bits(), 0xd7e772cee186176bU);
  EXPECT_EQ(zero.Bits(), 0x7e68b68aec7ba23bU);
  // Which word of counter and key is which, and the step from block to block.
  Draws draws(1, 2, 3);
  std::array<std::uint64_t, 5> words;
  for (std::uint64_t& word : words) word = draws.Bits();
  EXPECT_EQ(words[0], 0xae6a312222b9308bU);
  EXPECT_EQ(words[4], 0x0751716d93123b8fU);
}

TEST(Random, NamesStreamsByFnv1a) {
  // Published test vectors of FNV-1a, 64 bit.
  static_assert(StreamId("") == 0xcbf29ce484222325U);
  static_assert(StreamId("a") == 0xaf63dc4c8601ec8cU);
  static_assert(StreamId("foobar") == 0x85944171f73967e8U);
}

TEST(Random, MapsAWordToUnitIntervalsWithoutLoss) {
  bool lowest_bit = false;
  for (std::uint64_t index = 0; index < 1000; ++index) {
    Draws words(1, 42, index), uniform(1, 42, index), open(1, 42, index);
    for (int i = 0; i < 12; ++i) {
      const std::uint64_t word = words.Bits();
      const double u = uniform.Uniform(), v = open.OpenUniform();
      EXPECT_EQ(u * 0x1p53, static_cast<double>(word >> 11));
      EXPECT_TRUE(0 < v && v < 1);
      // An odd multiple of 2^-53 strictly inside the interval of the word's top 52 bits.
      EXPECT_EQ(std::fmod(v * 0x1p53, 2.0), 1.0);
      EXPECT_EQ(std::floor(v * 0x1p52), static_cast<double>(word >> 12));
      lowest_bit |= std::fmod(u * 0x1p53, 2.0) == 1.0;
    }
  }
  EXPECT_TRUE(lowest_bit) << "Uniform has fewer than 53 bits";
}

TEST(Random, TakesLogarithmsWithinThreeRoundoffs) {
  const auto error = [](double x) {
    const long double truth = std::log(static_cast<long double>(x));
    return truth == 0 ? std::fabs(PortableLog(x))
                      : static_cast<double>(std::fabs(PortableLog(x) / truth - 1));
  };
  double worst = error(1.0);
  for (int exponent = -1022; exponent <= 1023; ++exponent) {
    Draws draws(StreamId("log"), 1, static_cast<std::uint64_t>(exponent + 1022));
    for (int i = 0; i < 100; ++i) {
      worst = std::max(worst, error(std::ldexp(1 + draws.Uniform(), exponent)));
    }
  }
  for (int k = 1; k <= 52; ++k) {  // near 1, where the logarithm vanishes
    worst = std::max({worst, error(1 + std::ldexp(1.0, -k)), error(1 - std::ldexp(1.0, -k))});
  }
  EXPECT_LT(worst / 0x1p-53, 3.0);
}

TEST(Random, InvertsTheNormalDistributionTo1e15) {
  const boost::math::normal_distribution<long double> normal;
  double worst = 0, worst_p = 0;
  const auto check = [&](double p) {
    const long double truth = boost::math::quantile(normal, static_cast<long double>(p));
    const double error = static_cast<double>(std::fabs(NormalQuantile(p) / truth - 1));
    if (error > worst) {
      worst = error;
      worst_p = p;
    }
  };
  for (int i = 1; i <= 30000; ++i) check(std::pow(10.0, -i * 0.01));
  for (int i = 1; i <= 9999; ++i) check(i == 5000 ? 0.4999 : i * 1e-4);
  for (int k = 2; k <= 53; ++k) {
    check(1 - std::ldexp(1.0, -k));
    check(0.5 + std::ldexp(1.0, -k));
    check(0.5 - std::ldexp(1.0, -k));
  }
  for (const double tail : {0.075, 1.388794386496402e-11}) {  // where the approximations meet
    for (const double p : {tail, 1 - tail}) {
      check(std::nextafter(p, 0));
      check(p);
      check(std::nextafter(p, 1));
    }
  }
  EXPECT_EQ(NormalQuantile(0.5), 0);
  EXPECT_LT(worst, 1e-15) << "at p = " << worst_p;
}

TEST(Random, DrawsNormalsSymmetrically) {
  for (std::uint64_t index = 0; index < 10000; ++index) {
    const double u = Draws(1, 42, index).OpenUniform();
    EXPECT_EQ(NormalQuantile(u), -NormalQuantile(1 - u));
  }
}

TEST(Sampling, DrawsTheSameForAnyOrderOfIndices) {
  for (const Distribution& distribution : AllDistributions()) {
    std::vector<Configuration> forward;
    for (std::uint64_t index = 0; index < 100; ++index) {
      forward.push_back(Draw(distribution.name, "edge_edge", 42, index));
    }
    for (std::uint64_t index = 100; index-- > 0;) {
      EXPECT_EQ(Draw(distribution.name, "edge_edge", 42, index), forward[index]);
    }
  }
}

TEST(Sampling, DrawsTheSameBitsOnEveryMachine) {
  // The first vertex of configuration 1234567 of seed 42, and an FNV-1a hash of the bits of the
  // first 100,000 configurations.
  struct Golden {
    std::string_view distribution, stencil;
    std::array<double, 3> first;
    std::uint64_t hash;
  };
  const Golden kGolden[] = {
      {"paper",
       "vertex_face",
       {0x1.9572532002ef8p-2, 0x1.ab8512312ee68p-1, 0x1.e9ea0e7c06d6p-3},
       0x74f1fcc0d3d285d0},
      {"normal",
       "vertex_face",
       {0x1.4c77cb699c6cfp+0, 0x1.0d81f3243a655p+0, 0x1.d1b87008eae55p-1},
       0x6525ca79dc3a7c87},
      {"active",
       "vertex_face",
       {0x1.771391fce8a18p-3, 0x1.c3360701fa063p-5, -0x1.0408508dddccdp-5},
       0xd03ed6f71e87a9ab},
      {"active",
       "edge_edge",
       {-0x1.5faee25e829ccp-2, 0x1.88998a4cd145cp-1, -0x1.4837f7efea3bbp+0},
       0x954e7f7c2d01bd61},
  };
  for (const Golden& golden : kGolden) {
    const Configuration x = Draw(golden.distribution, golden.stencil, 42, 1234567);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(x[i], golden.first[i]) << golden.distribution << ' ' << golden.stencil;
    }
    std::uint64_t hash = StreamId("");
    for (std::uint64_t index = 0; index < 100000; ++index) {
      for (const double value : Draw(golden.distribution, golden.stencil, 42, index)) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
      }
    }
    EXPECT_EQ(hash, golden.hash) << golden.distribution << ' ' << golden.stencil;
  }
}

TEST(Sampling, DrawsUniformCoordinatesForPaper) {
  const std::vector<double> sample = Coordinates("paper");
  const auto [min, max] = std::minmax_element(sample.begin(), sample.end());
  EXPECT_GE(*min, 0);
  EXPECT_LT(*max, 1);
  EXPECT_LT(KolmogorovSmirnov(sample, UniformCdf), kKolmogorovBound);
  EXPECT_LT(MomentDeviation(sample, 1, 1.0 / 2), 4);
  EXPECT_LT(MomentDeviation(sample, 2, 1.0 / 3), 4);
}

TEST(Sampling, DrawsNormalCoordinatesForNormal) {
  const std::vector<double> sample = Coordinates("normal");
  EXPECT_LT(KolmogorovSmirnov(sample, NormalCdf), kKolmogorovBound);
  EXPECT_LT(MomentDeviation(sample, 1, 0), 4);
  EXPECT_LT(MomentDeviation(sample, 2, 1), 4);
  EXPECT_LT(MomentDeviation(sample, 4, 3), 4);
}

TEST(Sampling, KeepsCoordinatesOfOneConfigurationUncorrelated) {
  for (const std::string_view name : {"paper", "normal"}) {
    const double mean = name == "paper" ? 0.5 : 0.0, variance = name == "paper" ? 1.0 / 12 : 1.0;
    constexpr int kCount = 10000;
    std::array<std::array<double, 12>, 12> covariance{};
    for (std::uint64_t index = 0; index < kCount; ++index) {
      const Configuration x = Draw(name, "edge_edge", 42, index);
      for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t j = 0; j < i; ++j) covariance[i][j] += (x[i] - mean) * (x[j] - mean);
      }
    }
    for (std::size_t i = 0; i < 12; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_LT(std::fabs(covariance[i][j]) / (variance * std::sqrt(double{kCount})), 4);
      }
    }
  }
}

TEST(Sampling, KeepsStreamsIndependent) {
  constexpr std::uint64_t kCount = 100000;
  constexpr std::uint64_t kPaper = StreamId("paper"), kNormal = StreamId("normal");
  struct Stream {
    std::uint64_t stream, seed, shift;
  };
  // One change each of distribution, seed and index; the last two are where a careless key, such
  // as seed + index, would collide.
  const Stream kOthers[] = {
      {kNormal, 42, 0}, {kPaper, 43, 0}, {kPaper, 42, 1}, {kPaper, 41, 1}, {kPaper, 43, 1}};
  const auto first = [](const Stream& s, std::uint64_t index) {
    return Draws(s.stream, s.seed, index + s.shift).Uniform() - 0.5;
  };
  for (const Stream& other : kOthers) {
    double correlation = 0;
    for (std::uint64_t index = 0; index < kCount; ++index) {
      correlation += 12 * first({kPaper, 42, 0}, index) * first(other, index);
    }
    EXPECT_LT(std::fabs(correlation) / std::sqrt(static_cast<double>(kCount)), 4)
        << other.stream << ' ' << other.seed << ' ' << other.shift;
  }
  std::set<std::uint64_t> words;
  for (const std::uint64_t stream : {kPaper, kNormal}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      for (std::uint64_t index = 0; index < 100; ++index) {
        Draws draws(stream, seed, index);
        for (int i = 0; i < 12; ++i) words.insert(draws.Bits());
      }
    }
  }
  EXPECT_EQ(words.size(), 2U * 10 * 100 * 12);
}

// A pair's shape in extended precision: edges, signed length and the coordinates of its closest
// points, as collision kernels define them.
struct Shape {
  using Vec = std::array<long double, 3>;

  Vec e0, e1, e2;
  long double l, beta, gamma;
  double rounding;  // what rounding of the coordinates may do to the three, generously

  static long double Dot(const Vec& v, const Vec& w) {
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  }

  Shape(std::string_view stencil, const Configuration& x) {
    const auto edge = [&](std::size_t from, std::size_t to) {
      Vec e;
      for (std::size_t i = 0; i < 3; ++i) {
        e[i] = static_cast<long double>(x[3 * to + i]) - x[3 * from + i];
      }
      return e;
    };
    const bool vertex_face = stencil == "vertex_face";
    e0 = vertex_face ? edge(2, 1) : edge(0, 1);
    e1 = edge(2, 3);
    e2 = vertex_face ? edge(2, 0) : edge(0, 2);
    const Vec cross = {e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                       e0[0] * e1[1] - e0[1] * e1[0]};
    const long double g00 = Dot(e0, e0), g01 = Dot(e0, e1), g11 = Dot(e1, e1);
    const long double area2 = Dot(cross, cross);
    l = Dot(cross, e2) / std::sqrt(area2);
    beta = (g11 * Dot(e0, e2) - g01 * Dot(e1, e2)) / area2;
    gamma = (g00 * Dot(e1, e2) - g01 * Dot(e0, e2)) / area2;
    // Longest edge over the smallest height of the two edges' parallelogram.
    const long double aspect2 = std::max({g00, g11, Dot(e2, e2)}) * std::max(g00, g11) / area2;
    rounding = static_cast<double>(20 * 0x1p-53L * aspect2);
  }
};

constexpr std::uint64_t kShapes = 20000;

std::vector<Shape> ActiveShapes(std::string_view stencil) {
  std::vector<Shape> shapes;
  for (std::uint64_t index = 0; index < kShapes; ++index) {
    shapes.emplace_back(stencil, Draw("active", stencil, 42, index));
  }
  return shapes;
}

TEST(Sampling, DrawsActiveVertexFacePairsWithTheLengthAndClosestPointItChose) {
  for (std::uint64_t index = 0; index < kShapes; ++index) {
    Draws draws(StreamId("active"), 42, index);
    for (int i = 0; i < 9; ++i) draws.Normal();
    double beta, gamma;
    do {
      beta = draws.OpenUniform();
      gamma = draws.OpenUniform();
    } while (beta + gamma >= 1);
    const double l = 0.1 * (2 * draws.OpenUniform() - 1);

    const Configuration x = Draw("active", "vertex_face", 42, index);
    const Shape shape("vertex_face", x);
    EXPECT_NEAR(static_cast<double>(shape.l), l, shape.rounding);
    EXPECT_NEAR(static_cast<double>(shape.beta), beta, shape.rounding);
    EXPECT_NEAR(static_cast<double>(shape.gamma), gamma, shape.rounding);
    for (std::size_t i = 6; i < 9; ++i) EXPECT_EQ(x[i], 0);
  }
}

TEST(Sampling, DrawsActiveEdgeEdgePairsWithTheLengthAndClosestPointsItChose) {
  for (std::uint64_t index = 0; index < kShapes; ++index) {
    Draws draws(StreamId("active"), 42, index);
    for (int i = 0; i < 12; ++i) draws.Normal();
    const double a = draws.OpenUniform();
    const double b = draws.OpenUniform();
    const double l = 0.1 * (2 * draws.OpenUniform() - 1);

    const Configuration x = Draw("active", "edge_edge", 42, index);
    const Shape shape("edge_edge", x);
    EXPECT_NEAR(static_cast<double>(shape.l), l, shape.rounding);
    EXPECT_NEAR(static_cast<double>(shape.beta), a, shape.rounding);
    EXPECT_NEAR(static_cast<double>(-shape.gamma), b, shape.rounding);
    for (std::size_t i = 6; i < 9; ++i) EXPECT_EQ(x[i], 0);
  }
}

TEST(Sampling, DrawsActiveLengthsUniformlyInsideEps) {
  for (const std::string_view stencil : {"vertex_face", "edge_edge"}) {
    std::vector<double> lengths;
    for (const Shape& shape : ActiveShapes(stencil)) {
      EXPECT_LT(std::fabs(shape.l), 0.1L);
      lengths.push_back(static_cast<double>(shape.l));
    }
    const auto cdf = [](double l) { return 5 * (l + 0.1); };
    EXPECT_LT(KolmogorovSmirnov(lengths, cdf), kKolmogorovBound);
  }
}

TEST(Sampling, DrawsActiveClosestPointsUniformlyInTheInterior) {
  std::array<std::vector<double>, 3> phi;
  for (const Shape& shape : ActiveShapes("vertex_face")) {
    const long double third = 1 - shape.beta - shape.gamma;
    EXPECT_TRUE(shape.beta > 0 && shape.gamma > 0 && third > 0);
    phi[0].push_back(static_cast<double>(shape.beta));
    phi[1].push_back(static_cast<double>(shape.gamma));
    phi[2].push_back(static_cast<double>(third));
  }
  const auto triangle_cdf = [](double x) { return 1 - (1 - x) * (1 - x); };
  for (const auto& sample : phi) {
    EXPECT_LT(KolmogorovSmirnov(sample, triangle_cdf), kKolmogorovBound);
  }

  std::vector<double> a, b;
  for (const Shape& shape : ActiveShapes("edge_edge")) {
    EXPECT_TRUE(0 < shape.beta && shape.beta < 1 && 0 < -shape.gamma && -shape.gamma < 1);
    a.push_back(static_cast<double>(shape.beta));
    b.push_back(static_cast<double>(-shape.gamma));
  }
  EXPECT_LT(KolmogorovSmirnov(a, UniformCdf), kKolmogorovBound);
  EXPECT_LT(KolmogorovSmirnov(b, UniformCdf), kKolmogorovBound);
}

TEST(Sampling, DrawsActiveEdgesAsDifferencesOfNormalVertices) {
  for (const std::string_view stencil : {"vertex_face", "edge_edge"}) {
    std::vector<double> e0, e1, product;
    for (const Shape& shape : ActiveShapes(stencil)) {
      for (std::size_t i = 0; i < 3; ++i) {
        e0.push_back(static_cast<double>(shape.e0[i]));
        e1.push_back(static_cast<double>(shape.e1[i]));
        product.push_back(static_cast<double>(shape.e0[i] * shape.e1[i]));
      }
    }
    const auto cdf = [](double x) { return NormalCdf(x / std::sqrt(2.0)); };
    EXPECT_LT(KolmogorovSmirnov(e0, cdf), kKolmogorovBound);
    EXPECT_LT(KolmogorovSmirnov(e1, cdf), kKolmogorovBound);
    // The triangle's edges share a vertex, those of a pair of edges do not.
    const double shared = stencil == "vertex_face" ? 1.0 : 0.0;
    EXPECT_LT(MomentDeviation(product, 1, shared), 4);
  }
}

TEST(Sampling, DrawsActiveVerticesBesideAnEdgeAndNearAVertex) {
  std::vector<double> along, beside, apart;
  for (std::uint64_t index = 0; index < kShapes; ++index) {
    const Configuration pair = Draw("active", "vertex_edge", 42, index);
    double de = 0, ee = 0, dd = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double d = pair[i] - pair[3 + i], e = pair[6 + i] - pair[3 + i];
      de += d * e;
      ee += e * e;
      dd += d * d;
    }
    along.push_back(de / ee);
    beside.push_back(std::sqrt(std::max(0.0, dd - de * de / ee)) / 0.1);
    const Configuration vertices = Draw("active", "vertex_vertex", 42, index);
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      square += (vertices[3 + i] - vertices[i]) * (vertices[3 + i] - vertices[i]);
    }
    apart.push_back(std::sqrt(square) / 0.1);
  }
  for (const auto* values : {&along, &beside, &apart}) {
    EXPECT_LT(KolmogorovSmirnov(*values, UniformCdf), kKolmogorovBound);
  }
}

TEST(Sampling, OverridesParametersByName) {
  // In the order eps, eta, k, side; eta is the energy's own.
  using Parameters = std::array<double, 4>;
  EXPECT_EQ(DrawParameters("paper"), (Parameters{1, 8, 1, 0}));
  EXPECT_EQ(DrawParameters("normal"), (Parameters{1, 8, 1, 0}));
  EXPECT_EQ(DrawParameters("active"), (Parameters{0.1, 8, 1, 0}));
}

TEST(Sampling, FillsAsManyCoordinatesAsTheEnergyHas) {
  for (const std::string_view name : {"paper", "normal"}) {
    std::array<double, 10> x;
    x.fill(-100);
    FindDistribution(name)->draw({"corner", 9, {}}, 42, 0, x.data(), nullptr);
    EXPECT_TRUE(std::none_of(x.begin(), x.end() - 1, [](double v) { return v == -100; }));
    EXPECT_EQ(x[9], -100);
  }
}

TEST(Sampling, KnowsWhichStencilsADistributionSupports) {
  for (const std::string_view stencil :
       {"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex", "corner", "segment", "hinge"}) {
    EXPECT_TRUE(FindDistribution("paper")->supports(stencil));
    EXPECT_TRUE(FindDistribution("normal")->supports(stencil));
    EXPECT_EQ(FindDistribution("active")->supports(stencil), stencil != "hinge");
  }
}

TEST(Sampling, FindsDistributionsByUniqueNames) {
  std::set<std::string_view> names;
  for (const Distribution& distribution : AllDistributions()) {
    EXPECT_EQ(FindDistribution(distribution.name), &distribution);
    EXPECT_FALSE(distribution.description.empty());
    names.insert(distribution.name);
  }
  EXPECT_EQ(names.size(), AllDistributions().size());
  for (const auto name : {"active", "normal", "paper"}) EXPECT_EQ(names.count(name), 1U) << name;
  EXPECT_EQ(FindDistribution("papers"), nullptr);
}

}  // namespace
}  // namespace definite
