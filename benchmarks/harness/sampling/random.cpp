#include "benchmarks/harness/sampling/random.hpp"

#include <Random123/philox.h>

#include <bit>
#include <cmath>

namespace definite {
namespace {

// Two polynomials of degree 7, coefficients from the highest power down.
struct Rational {
  double numerator[8], denominator[8];

  double operator()(double x) const {
    double top = numerator[0], bottom = denominator[0];
    for (int i = 1; i < 8; ++i) {
      top = top * x + numerator[i];
      bottom = bottom * x + denominator[i];
    }
    return top / bottom;
  }
};

// AS 241's three approximations: for |p - 1/2| <= 0.425, and for r = sqrt(-log(tail)) up to 5 and
// beyond.
constexpr Rational kCentre = {
    {2.5090809287301226727e+3, 3.3430575583588128105e+4, 6.7265770927008700853e+4,
     4.5921953931549871457e+4, 1.3731693765509461125e+4, 1.9715909503065514427e+3,
     1.3314166789178437745e+2, 3.3871328727963666080e+0},
    {5.2264952788528545610e+3, 2.8729085735721942674e+4, 3.9307895800092710610e+4,
     2.1213794301586595867e+4, 5.3941960214247511077e+3, 6.8718700749205790830e+2,
     4.2313330701600911252e+1, 1.0}};
constexpr Rational kTail = {
    {7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1,
     1.27045825245236838258e+0, 3.64784832476320460504e+0, 5.76949722146069140550e+0,
     4.63033784615654529590e+0, 1.42343711074968357734e+0},
    {1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2,
     1.48103976427480074590e-1, 6.89767334985100004550e-1, 1.67638483018380384940e+0,
     2.05319162663775882187e+0, 1.0}};
constexpr Rational kFarTail = {
    {2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3,
     2.65321895265761230930e-2, 2.96560571828504891230e-1, 1.78482653991729133580e+0,
     5.46378491116411436990e+0, 6.65790464350110377720e+0},
    {2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5,
     7.86869131145613259100e-4, 1.48753612908506148525e-2, 1.36929880922735805310e-1,
     5.99832206555887937690e-1, 1.0}};

}  // namespace

double PortableLog(double x) {
  // x = 2^exponent m with m in [sqrt(1/2), sqrt(2)).
  constexpr auto kSqrtHalf = std::bit_cast<std::uint64_t>(0x1.6a09e667f3bcdp-1);
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::int64_t exponent = static_cast<std::int64_t>(bits - kSqrtHalf) >> 52;
  const double m = std::bit_cast<double>(bits - (static_cast<std::uint64_t>(exponent) << 52));

  // log m = 2 atanh(s), s = (m-1)/(m+1). With s^2 < 0.0295 the first term left out is below
  // 1e-18 of the sum.
  constexpr double kSeries[] = {1. / 21, 1. / 19, 1. / 17, 1. / 15, 1. / 13,
                                1. / 11, 1. / 9,  1. / 7,  1. / 5,  1. / 3};
  const double s = (m - 1) / (m + 1);
  const double z = s * s;
  double sum = 0;
  for (const double coefficient : kSeries) sum = (sum + coefficient) * z;

  // log 2 in two parts, the first short enough that its product with the exponent is exact.
  constexpr double kLog2High = 0x1.62e42feep-1, kLog2Low = 0x1.a39ef35793c76p-33;
  const double k = static_cast<double>(exponent);
  return k * kLog2High + (2 * (s + s * sum) + k * kLog2Low);
}

double NormalQuantile(double p) {
  const double q = p - 0.5;
  if (std::fabs(q) <= 0.425) return q * kCentre(0.425 * 0.425 - q * q);
  const double r = std::sqrt(-PortableLog(q < 0 ? p : 1 - p));
  const double x = r <= 5 ? kTail(r - 1.6) : kFarTail(r - 5);
  return q < 0 ? -x : x;
}

void Draws::Refill() {
  const r123::Philox4x64::ctr_type counter = {{index_, block_++, 0, 0}};
  const r123::Philox4x64::key_type key = {{seed_, stream_}};
  const auto block = r123::Philox4x64{}(counter, key);
  words_ = {block[0], block[1], block[2], block[3]};
  next_ = 0;
}

}  // namespace definite
