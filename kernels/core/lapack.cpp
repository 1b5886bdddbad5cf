#include "kernels/core/lapack.hpp"

#include <cstring>

#include "kernels/core/eigen.hpp"

extern "C" {
void dsyevd_(const char* job, const char* triangle, const int* n, double* a, const int* stride,
             double* values, double* work, const int* work_size, int* integers,
             const int* integers_size, int* info);
void dsyevr_(const char* job, const char* range, const char* triangle, const int* n, double* a,
             const int* stride, const double* from, const double* to, const int* first,
             const int* last, const double* tolerance, int* found, double* values, double* vectors,
             const int* vectors_stride, int* support, double* work, const int* work_size,
             int* integers, const int* integers_size, int* info);
void openblas_set_num_threads(int threads);
}

namespace definite {

namespace {

constexpr int kN = 12;

// Eigenvalues ascend; vectors are rows.
struct Eigenpairs {
  double values[kN], vectors[kN][kN];
};

// Both destroy the upper triangle of a, row by row, and say whether they converged. Their work
// space has the sizes that LAPACK documents.
bool SolveByD(double (&a)[kN][kN], Eigenpairs& pairs) {
  constexpr int kWork = 1 + 6 * kN + 2 * kN * kN, kIntegers = 3 + 5 * kN;
  double work[kWork];
  int integers[kIntegers], info;
  dsyevd_("V", "L", &kN, a[0], &kN, pairs.values, work, &kWork, integers, &kIntegers, &info);
  std::memcpy(pairs.vectors, a, sizeof(a));
  return info == 0;
}
bool SolveByR(double (&a)[kN][kN], Eigenpairs& pairs) {
  constexpr int kWork = 26 * kN, kIntegers = 10 * kN;
  constexpr double kNoBound = 0, kTolerance = 0;
  constexpr int kNoIndex = 0;
  double work[kWork];
  int integers[kIntegers], support[2 * kN], found, info;
  dsyevr_("V", "A", "L", &kN, a[0], &kN, &kNoBound, &kNoBound, &kNoIndex, &kNoIndex, &kTolerance,
          &found, pairs.values, pairs.vectors[0], &kN, support, work, &kWork, integers, &kIntegers,
          &info);
  return info == 0 && found == kN;
}

}  // namespace

PackedSym<double, kN> ClampByLapack(const PackedSym<double, kN>& h, LapackDriver driver) {
  // A 12x12 matrix is no work for a second thread.
  [[maybe_unused]] static const bool one_thread = (openblas_set_num_threads(1), true);
  double a[kN][kN];  // LAPACK reads it column by column: this is its lower triangle
  int k = 0;
  for (int i = 0; i < kN; ++i) {
    for (int j = i; j < kN; ++j) a[i][j] = h.a[k++];
  }
  Eigenpairs pairs;
  const bool converged =
      driver == LapackDriver::kDivideAndConquer ? SolveByD(a, pairs) : SolveByR(a, pairs);
  if (!converged) return MapEigenvalues(h, ClampToPsd);
  PackedSym<double, kN> positive{};
  for (int m = kN - 1; m >= 0 && pairs.values[m] > 0; --m) {
    const double* v = pairs.vectors[m];
    double* to = positive.a;
    for (int i = 0; i < kN; ++i) {
      const double weighted = pairs.values[m] * v[i];
      for (int j = i; j < kN; ++j) *to++ += weighted * v[j];
    }
  }
  return positive;
}

}  // namespace definite
