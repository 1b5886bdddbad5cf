#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/energy.hpp"
#include "reference/spectrum.hpp"

namespace definite::reference {

// Everything known about one configuration (x, p) of an energy, each quantity computed on first use
// and kept. Outside the energy's domain every quantity is NaN; where inactive all are zero but the
// length and the maps of the frame. Not thread safe; cheap to make.
template <class T>
class Truth {
 public:
  // x has energy.dofs entries, p has energy.params; both are copied. `energy` must outlive this.
  template <class U>
  Truth(const Energy<T>& energy, const U* x, const U* p)
      : energy_(energy),
        x_(x, x + energy.dofs),
        p_(p, p + energy.params),
        in_domain_(energy.in_domain(x_.data(), p_.data())) {}

  const Energy<T>& Of() const { return energy_; }
  bool InDomain() const { return in_domain_; }
  bool Active() const { return in_domain_ && energy_.active(x_.data(), p_.data()); }

  const T& Value() { return AllDerivatives().value; }
  const Matrix<T>& Gradient() { return AllDerivatives().gradient; }
  const Matrix<T>& Hessian() { return AllDerivatives().hessian; }

  const Spectrum<T>& HessianSpectrum() {
    return Keep(spectrum_, [&] { return reference::SpectrumOf(Hessian()); });
  }
  // The PSD matrix nearest to the Hessian in the Frobenius norm.
  const Matrix<T>& Nearest() {
    return Keep(nearest_, [&] { return NearestPsd(HessianSpectrum(), MostPositive()); });
  }
  // Gauss-Newton: psi''(s) grad s grad s^T. Throws std::logic_error if the energy is not a penalty
  // of a scalar.
  const Matrix<T>& Curvature() {
    return Keep(curvature_,
                [&] { return At(energy_.curvature, Undefined(energy_.dofs, energy_.dofs)); });
  }
  // The terms map^T hessian map that sum to the Hessian, and the spectra of their Hessians. Outside
  // the domain there is one. Both throw std::logic_error if the energy has no frame.
  const std::vector<FrameTerm<T>>& FrameTerms() {
    const int n = energy_.dofs, m = energy_.frame_dofs;
    return Keep(frame_, [&] { return At(energy_.frame, {{Undefined(m, m), Undefined(m, n)}}); });
  }
  const std::vector<Spectrum<T>>& FrameSpectra() {
    return Keep(frame_spectra_, [&] {
      std::vector<Spectrum<T>> spectra;
      for (const FrameTerm<T>& term : FrameTerms()) spectra.push_back(SpectrumOf(term));
      return spectra;
    });
  }

 private:
  template <class Q, class F>
  static const Q& Keep(std::optional<Q>& kept, F compute) {
    if (!kept) kept = compute();
    return *kept;
  }
  template <class Q>
  Q At(Q (*function)(const T*, const T*), Q undefined) const {
    if (!function) throw std::logic_error(energy_.name + " has no such quantity");
    return in_domain_ ? function(x_.data(), p_.data()) : undefined;
  }
  // How many positive eigenvalues the Hessian may have. Pulled back by one map it has no more than
  // in the frame, where it has none that translations make 0.
  int MostPositive() {
    if (!energy_.frame || FrameTerms().size() != 1) return energy_.dofs;
    const Matrix<T>& values = FrameSpectra()[0].values;
    return static_cast<int>(std::count_if(values.entries.begin(), values.entries.end(),
                                          [](const T& value) { return !(value <= 0); }));
  }
  static Matrix<T> Undefined(int m, int n) { return Matrix<T>(m, n, kNaN); }

  // The quicker solver errs by what is small beside |hessian|. A map with long rows, as of a foot
  // point far outside a short edge, would make that large beside the small eigenvalues.
  static Spectrum<T> SpectrumOf(const FrameTerm<T>& term) {
    const T map = FrobeniusNorm(term.map),
            whole = FrobeniusNorm(Congruence(term.hessian, term.map));
    const bool magnified = map * map * FrobeniusNorm(term.hessian) > T(1e8) * whole;
    return magnified ? JacobiSpectrum(term.hessian) : reference::SpectrumOf(term.hessian);
  }

  const Derivatives<T>& AllDerivatives() {
    const int n = energy_.dofs;
    return Keep(derivatives_, [&] {
      return At(energy_.derivatives, {kNaN, Undefined(n, 1), Undefined(n, n)});
    });
  }

  inline static const T kNaN = std::numeric_limits<T>::quiet_NaN();

  const Energy<T>& energy_;
  std::vector<T> x_;
  std::vector<T> p_;
  bool in_domain_;
  std::optional<Derivatives<T>> derivatives_;
  std::optional<Spectrum<T>> spectrum_;
  std::optional<Matrix<T>> nearest_;
  std::optional<Matrix<T>> curvature_;
  std::optional<std::vector<FrameTerm<T>>> frame_;
  std::optional<std::vector<Spectrum<T>>> frame_spectra_;
};

}  // namespace definite::reference
