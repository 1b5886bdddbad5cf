#pragma once

#include <array>
#include <concepts>
#include <string>
#include <vector>

#include "reference/dual.hpp"
#include "reference/matrix.hpp"
#include "reference/spectrum.hpp"

namespace definite::reference {

template <class T>
struct Derivatives {
  T value;
  Matrix<T> gradient;  // dofs x 1
  Matrix<T> hessian;   // dofs x dofs
};

// A term map^T hessian map of psi's Hessian, in the frame coordinates c.
template <class T>
struct FrameTerm {
  Matrix<T> hessian;  // frame_dofs x frame_dofs
  Matrix<T> map;      // frame_dofs x dofs
};

// One energy psi(x; p), by name. x has `dofs` entries, p has `params`; units are the caller's. Ask
// in_domain first: outside, the other functions may return anything. Where psi is not active (it
// vanishes identically nearby) they return zeros. A function that psi has no use for is null. In
// double nothing is scaled: entries of x beyond about 1e+-50 overflow or underflow; Quad takes
// every double.
template <class T>
struct Energy {
  std::string name;
  int dofs;
  int params;
  int frame_dofs;  // 0: no frame
  bool (*in_domain)(const T* x, const T* p);
  bool (*active)(const T* x, const T* p);
  // At most 1: what bounds on rounding are divided by (docs/protocol.md, section 1).
  double (*conditioning)(const T* x, const T* p);
  T (*value)(const T* x, const T* p);
  Derivatives<T> (*derivatives)(const T* x, const T* p);
  T (*length)(const T* x, const T* p);  // s, a scalar s(x) that psi is a penalty of
  // psi''(s) grad s grad s^T, or the sum of grad r grad r^T over residuals, dofs x dofs.
  Matrix<T> (*curvature)(const T* x, const T* p);
  // The terms that sum to the Hessian; the first one's map is S, c = S x with weights frozen at x.
  std::vector<FrameTerm<T>> (*frame)(const T* x, const T* p);
};

// What an energy must define, in plain form, for any scalar S (T itself or dual numbers over it).
// Optional:
//   Length(x, p), and Penalty(s, p) if psi = Penalty(Length), not a penalty of other things too;
//   Residuals(x, p), if psi is half of the sum of their squares;
//   kFrameDofs; FrameAt(x, at, p), the frame coordinates c of x with their weights frozen at `at`
//   (T); FrameValue(c, at, p), psi of them, of which the Hessian loses nothing by frozen weights;
//   or none, where psi is no function of them: what of them the Hessian is, is then found by
//   fitting; RemainderValue(c, at, p), the part of psi that loses something, a minimum over the
//   weights, and FreeFrame(x, p), the coordinates with weights that follow x. With S and S + D the
//   Jacobians of FrameAt and FreeFrame, the part's Hessian is S^T Hc S - D^T Hc D (Shi & Kim 2023,
//   Eq. 17).
template <class E>
concept EnergyDefinition = requires(const Dual2<double, E::kDofs>* x, const double* p) {
  { E::Name() } -> std::same_as<std::string>;
  { E::kParams } -> std::convertible_to<int>;
  { E::Value(x, p) } -> std::same_as<Dual2<double, E::kDofs>>;
  { E::InDomain(p, p) } -> std::same_as<bool>;
  { E::Active(p, p) } -> std::same_as<bool>;
  { E::Conditioning(p, p) } -> std::same_as<double>;
};

// The line by which CMake finds an energy: on one line, in namespace definite::reference.
#define DEFINITE_REFERENCE_ENERGY(...) \
  static_assert(::definite::reference::EnergyDefinition<__VA_ARGS__>)

template <class T, int N>
Derivatives<T> Unpack(const Dual2<T, N>& a) {
  Derivatives<T> d{a.value, Matrix<T>(N, 1), Matrix<T>(N, N)};
  for (int i = 0, k = 0; i < N; ++i) {
    d.gradient[i] = a.gradient[i];
    for (int j = i; j < N; ++j, ++k) d.hessian(i, j) = d.hessian(j, i) = a.hessian[k];
  }
  return d;
}

// The gradients of c, in rows.
template <class T, int N, size_t M>
Matrix<T> Jacobian(const std::array<Dual2<T, N>, M>& c) {
  Matrix<T> jacobian(M, N);
  for (int i = 0; i < jacobian.rows; ++i)
    for (int j = 0; j < N; ++j) jacobian(i, j) = c.data()[i].gradient[j];
  return jacobian;
}

// The a for which map^T a map is h, where there is one and the rows of map are independent: with
// their Gram matrix g, g^-1 map h map^T g^-1; and once more for what that leaves.
template <class T>
Matrix<T> Fitted(const Matrix<T>& h, const Matrix<T>& map) {
  const Matrix<T> transpose = Transpose(map);
  const Matrix<T> inverse =
      MapSpectrum(JacobiSpectrum(map * transpose), [](const T& g) { return 1 / g; });
  const auto fit = [&](const Matrix<T>& rest) {
    return Congruence(Congruence(rest, transpose), inverse);
  };
  const Matrix<T> a = fit(h);
  return a + fit(h - Congruence(a, map));
}

// The table row of an energy: every derivative by automatic differentiation.
template <class T, EnergyDefinition E>
Energy<T> MakeEnergy() {
  Energy<T> row{};
  row.name = E::Name();
  row.dofs = E::kDofs;
  row.params = E::kParams;
  row.in_domain = [](const T* x, const T* p) { return E::InDomain(x, p); };
  row.active = [](const T* x, const T* p) { return E::Active(x, p); };
  row.conditioning = [](const T* x, const T* p) { return E::Conditioning(x, p); };
  row.value = [](const T* x, const T* p) { return E::Value(x, p); };
  row.derivatives = [](const T* x, const T* p) {
    return Unpack(E::Value(Variables<E::kDofs>(x).data(), p));
  };
  if constexpr (requires(const T* x) { E::Length(x, x); }) {
    row.length = [](const T* x, const T* p) { return E::Length(x, p); };
  }
  if constexpr (requires(const T* x) { E::Penalty(E::Length(x, x), x); }) {
    row.curvature = [](const T* x, const T* p) {
      const Derivatives<T> s = Unpack(E::Length(Variables<E::kDofs>(x).data(), p));
      const auto psi = E::Penalty(Variables<1>(&s.value)[0], p);
      return Outer(psi.hessian[0], s.gradient);
    };
  }
  if constexpr (requires(const T* x) { E::Residuals(x, x); }) {
    row.curvature = [](const T* x, const T* p) {
      const Matrix<T> slopes = Jacobian(E::Residuals(Variables<E::kDofs>(x).data(), p));
      Matrix<T> identity(slopes.rows, slopes.rows);
      for (int i = 0; i < slopes.rows; ++i) identity(i, i) = T(1);
      return Congruence(identity, slopes);
    };
  }
  if constexpr (requires { E::kFrameDofs; }) {
    row.frame_dofs = E::kFrameDofs;
    constexpr bool kHasRemainder = requires(const T* x) { E::RemainderValue(x, x, x); };
    row.frame = [](const T* x, const T* p) {
      const auto variables = Variables<E::kDofs>(x);
      const auto frozen = E::FrameAt(variables.data(), x, p);
      const auto values = Values<E::kFrameDofs>(frozen.data());
      const auto c = Variables<E::kFrameDofs>(values.data());
      const Matrix<T> map = Jacobian(frozen);
      if constexpr (!requires { E::FrameValue(c.data(), x, p); }) {
        return std::vector<FrameTerm<T>>{
            {Fitted(Unpack(E::Value(variables.data(), p)).hessian, map), map}};
      } else {
        std::vector<FrameTerm<T>> terms{{Unpack(E::FrameValue(c.data(), x, p)).hessian, map}};
        if constexpr (kHasRemainder) {
          const Matrix<T> hessian = Unpack(E::RemainderValue(c.data(), x, p)).hessian;
          terms.push_back({hessian, map});
          terms.push_back({-hessian, Jacobian(E::FreeFrame(variables.data(), p)) - map});
        }
        return terms;
      }
    };
  }
  return row;
}

}  // namespace definite::reference
