#pragma once

#include <cmath>
#include <vector>

namespace definite::reference {

// A dense rows x cols matrix, stored row by row. A vector is a matrix of one column.
template <class T>
struct Matrix {
  int rows = 0;
  int cols = 0;
  std::vector<T> entries;

  Matrix() = default;
  Matrix(int m, int n, T fill = T(0))
      : rows(m), cols(n), entries(static_cast<size_t>(m * n), fill) {}

  T& operator()(int i, int j) { return (*this)[i * cols + j]; }
  const T& operator()(int i, int j) const { return (*this)[i * cols + j]; }

  // The k-th stored entry: of a vector, its k-th.
  T& operator[](int k) { return entries.data()[k]; }
  const T& operator[](int k) const { return entries.data()[k]; }
};

template <class T>
Matrix<T> operator*(const Matrix<T>& a, const Matrix<T>& b) {
  Matrix<T> c(a.rows, b.cols);
  for (int i = 0; i < a.rows; ++i)
    for (int k = 0; k < a.cols; ++k)
      for (int j = 0; j < b.cols; ++j) c(i, j) += a(i, k) * b(k, j);
  return c;
}

template <class T>
Matrix<T> operator+(Matrix<T> a, const Matrix<T>& b) {
  for (size_t i = 0; i < a.entries.size(); ++i) a.entries[i] += b.entries[i];
  return a;
}

template <class T>
Matrix<T> operator-(Matrix<T> a, const Matrix<T>& b) {
  for (size_t i = 0; i < a.entries.size(); ++i) a.entries[i] -= b.entries[i];
  return a;
}

template <class T>
Matrix<T> operator-(const Matrix<T>& a) {
  return Matrix<T>(a.rows, a.cols) - a;
}

template <class T>
Matrix<T> Transpose(const Matrix<T>& a) {
  Matrix<T> t(a.cols, a.rows);
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.cols; ++j) t(j, i) = a(i, j);
  return t;
}

// Unscaled: the squares must neither overflow nor underflow in T.
template <class T>
T FrobeniusNorm(const Matrix<T>& a) {
  using std::sqrt;
  T sum(0);
  for (const T& entry : a.entries) sum += entry * entry;
  return sqrt(sum);
}

// weight v v^T, exactly symmetric.
template <class T>
Matrix<T> Outer(const T& weight, const Matrix<T>& v) {
  Matrix<T> a(v.rows, v.rows);
  for (int i = 0; i < v.rows; ++i)
    for (int j = i; j < v.rows; ++j) a(i, j) = a(j, i) = weight * (v[i] * v[j]);
  return a;
}

// s^T a s for a symmetric a (m x m) and any s (m x n); the n x n result is exactly symmetric.
template <class T>
Matrix<T> Congruence(const Matrix<T>& a, const Matrix<T>& s) {
  const Matrix<T> as = a * s;
  Matrix<T> c(s.cols, s.cols);
  for (int i = 0; i < s.cols; ++i) {
    for (int j = i; j < s.cols; ++j) {
      for (int k = 0; k < s.rows; ++k) c(i, j) += s(k, i) * as(k, j);
      c(j, i) = c(i, j);
    }
  }
  return c;
}

}  // namespace definite::reference
