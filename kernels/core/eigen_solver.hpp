#pragma once

// What eigen_solver.cpp offers, on plain numbers: its users include no Eigen, which takes half
// a minute to compile. eigen.hpp has the form that filters use.

namespace definite {

// What becomes of an eigenvalue. A NaN stays one.
using EigenvalueMap = double (*)(double lambda);

namespace internal {

// Packed upper triangles row by row; the modes are `count` vectors of F numbers, the map is F x D
// row by row.
template <int N>
void MapEigenvalues(const double* h, EigenvalueMap map, double* result);
template <int N>
void DropNegative(const double* h, double* result);
template <int N>
void ClampInFloat(const double* h, double* result);
template <int F, int D>
void PullBack(const double* lambda, const double* modes, int count, const double* map,
              EigenvalueMap eigenvalues, double* result);
// u, v: D vectors of D numbers each; scaling: D x D, packed; pairs: two numbers for each pair of
// stretches; map as above, D^2 x D(D + 1).
template <int D>
void ClampStretchBlocks(const double* u, const double* v, const double* scaling,
                        const double* pairs, const double* map, double* result);

}  // namespace internal
}  // namespace definite
