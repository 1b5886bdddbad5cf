// The rotation-variant singular value decomposition: residuals in float128, order, sign, lanes.

#include "kernels/distortion/svd.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/float128.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "reference/quad.hpp"

namespace definite {
namespace {

using reference::Quad;

constexpr double kBound = 50;  // of an error in units of u

template <int D>
struct Columns {
  Vec<double, D> c[D];
};

// A rotation from the decomposition's own columns would prove little: a product of plane ones.
template <int D>
Columns<D> Rotated(const Columns<D>& m, std::mt19937_64& draw, bool left) {
  std::uniform_real_distribution<double> angle(-3, 3);
  Columns<D> r = m;
  for (int p = 0; p < D; ++p) {
    for (int q = p + 1; q < D; ++q) {
      const double a = angle(draw), c = std::cos(a), s = std::sin(a);
      for (int k = 0; k < D; ++k) {
        double& x = left ? r.c[k][p] : r.c[p][k];
        double& y = left ? r.c[k][q] : r.c[q][k];
        const double turned = c * x - s * y;
        y = s * x + c * y;
        x = turned;
      }
    }
  }
  return r;
}

template <int D>
std::vector<Columns<D>> Cases() {
  std::mt19937_64 draw(7);
  std::normal_distribution<double> normal;
  std::vector<Columns<D>> cases;
  const double smallest[] = {1, 0.3, 1e-4, 1e-8, 1e-15, 0};
  for (int n = 0; n < 2000; ++n) {
    Columns<D> random, near, equal{}, singular{};
    for (int j = 0; j < D; ++j) {
      for (int i = 0; i < D; ++i) {
        random.c[j][i] = normal(draw);
        near.c[j][i] = (i == j) + 1e-6 * random.c[j][i];
      }
      equal.c[j][j] = 1.5;
      singular.c[j][j] = 1 + std::abs(normal(draw));
    }
    singular.c[D - 1][D - 1] = smallest[n % 6];
    if (D == 3 && n % 7 == 0) singular.c[1][1] = smallest[n / 7 % 6];
    if (n % 2) equal.c[D - 1][D - 1] = -1.5;
    if (n % 3 == 0) singular.c[D - 1][D - 1] *= -1;
    for (Columns<D>* m : {&random, &near, &equal, &singular}) {
      *m = Rotated(Rotated(*m, draw, true), draw, false);
      if (n % 11 == 0) {
        for (auto& c : m->c) c = (n % 2 ? 1e150 : 1e-150) * c;
      }
      cases.push_back(*m);
    }
  }
  Columns<D> zero{}, one{}, rank1{};
  for (int j = 0; j < D; ++j) one.c[j][j] = 1;
  for (auto& c : rank1.c) c[D - 1] = 1;
  for (const auto& m : {zero, one, rank1}) cases.push_back(m);
  return cases;
}

// The largest |F - U s V^T| in units of u max|F|, and |U^T U - 1|, |V^T V - 1| in units of u.
template <class T, int D>
double Defect(const Columns<D>& f, const RotationSvd<T, D>& r, double u) {
  Quad worst = 0, size = 0;
  for (const auto& c : f.c) {
    for (double a : c.v) size = std::max(size, Quad(std::abs(a)));
  }
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) {
      Quad residual = f.c[j][i], uu = i == j ? -1 : 0, vv = uu;
      for (int k = 0; k < D; ++k) {
        residual -= Quad(r.u[k][i]) * Quad(r.s[k]) * Quad(r.v[k][j]);
        uu += Quad(r.u[i][k]) * Quad(r.u[j][k]);
        vv += Quad(r.v[i][k]) * Quad(r.v[j][k]);
      }
      if (size > 0) residual /= size;
      for (const Quad& e : {residual, uu, vv}) {
        if (!(abs(e) <= worst)) worst = abs(e);  // NaN stays
      }
    }
  }
  return static_cast<double>(worst / u);
}

template <class T, int D>
Quad Determinant(const Vec<T, D> (&m)[D]) {
  Vec<Quad, D> c[D];
  for (int j = 0; j < D; ++j) {
    for (int i = 0; i < D; ++i) c[j][i] = Quad(m[j][i]);
  }
  if constexpr (D == 2) {
    return c[0][0] * c[1][1] - c[0][1] * c[1][0];
  } else {
    return Dot(Cross(c[0], c[1]), c[2]);
  }
}

template <int D>
void ExpectDecomposed() {
  for (const Columns<D>& f : Cases<D>()) {
    const auto r = SvdOf(f.c);
    EXPECT_LE(Defect(f, r, 0x1p-53), kBound);
    EXPECT_GT(Determinant(r.u), 0);
    EXPECT_GT(Determinant(r.v), 0);
    EXPECT_GE(r.s[D - 2], std::abs(r.s[D - 1]));
    EXPECT_GE(r.s[0], r.s[D - 2]);
    Vec<Quad, D> q[D];
    for (int j = 0; j < D; ++j) {
      for (int i = 0; i < D; ++i) q[j][i] = f.c[j][i];
    }
    const auto exact = SvdOf(q);
    EXPECT_LE(Defect(f, exact, 0x1p-113), kBound);
    for (int i = 0; i < D; ++i) {
      EXPECT_LE(abs(exact.s[i] - r.s[i]), kBound * 0x1p-53 * exact.s[0]) << i;
    }
    if (::testing::Test::HasFailure()) return;
  }
}

template <int D>
void ExpectLanesEqualScalar() {
  using L = Lanes<double, 4>;  // tests are built for machines without AVX-512
  const auto cases = Cases<D>();
  for (std::size_t first = 0; first + 4 <= cases.size(); first += 4) {
    Vec<L, D> f[D];
    double entries[4];
    for (int j = 0; j < D; ++j) {
      for (int i = 0; i < D; ++i) {
        for (std::size_t w = 0; w < 4; ++w) entries[w] = cases[first + w].c[j][i];
        f[j][i] = L::Load(entries);
      }
    }
    const auto lanes = SvdOf(f);
    const auto expect = [&](const L& lane, auto entry) {
      lane.Store(entries);
      for (std::size_t w = 0; w < 4; ++w) ASSERT_EQ(entries[w], entry(SvdOf(cases[first + w].c)));
    };
    for (int i = 0; i < D; ++i) {
      expect(lanes.s[i], [&](const auto& r) { return r.s[i]; });
      for (int j = 0; j < D; ++j) {
        expect(lanes.u[j][i], [&](const auto& r) { return r.u[j][i]; });
        expect(lanes.v[j][i], [&](const auto& r) { return r.v[j][i]; });
      }
    }
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Svd, ReproducesAMatrixOfThePlane) { ExpectDecomposed<2>(); }
TEST(Svd, ReproducesAMatrixOfSpace) { ExpectDecomposed<3>(); }
TEST(Svd, LanesEqualScalarInThePlane) { ExpectLanesEqualScalar<2>(); }
TEST(Svd, LanesEqualScalarInSpace) { ExpectLanesEqualScalar<3>(); }

}  // namespace
}  // namespace definite
