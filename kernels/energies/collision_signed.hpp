#pragma once

// psi(l) for a signed length l between two primitives.
//
// Source: Shi & Kim 2023: frame and modes in lengths/signed.hpp, psi in penalties/.
// Parameters: k (stiffness), eps (activation distance, a length), side (sign of the length: -1
// flips it, +1 and 0 do not).
// Domain: lengths/signed.hpp. Inactive where l >= eps.
// Bound: the Hessian's conditioned rounding is at most 50 (tests/accuracy_test.cpp).

#include <string>

#include "kernels/lengths/signed.hpp"
#include "kernels/penalties/quadratic.hpp"
#include "kernels/registry.hpp"
#include "kernels/stencils/vertex_face.hpp"

namespace definite {

template <class Primitive, class Penalty>
struct CollisionSigned {
  using Stencil = Primitive;
  using Length = SignedLength<Stencil>;
  static constexpr std::string_view kSource = "Shi & Kim 2023, Eqs. 1, 8-13, 16-19, 21";
  static constexpr int kDofs = Stencil::kDofs;
  static constexpr int kParams = 3;
  static constexpr Parameter kParameters[] = {
      {"k", 1.0, 0, "stiffness"},
      {"eps", 1.0, 1, "activation distance"},
      {"side", 0.0, 0, "sign of the length: -1 flips it, +1 and 0 keep the triple product's"},
  };

  static std::string Name() {
    return "collision/" + std::string(Stencil::kName) + "/signed/" + std::string(Penalty::kName);
  }

  template <class T>
  static DEFINITE_INLINE T Value(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    const T l = f.l / f.scale / f.lift;
    return Select((l >= p[1]) | f.outside, T(0.0), Penalty::Value(l, p[0], p[1]));
  }

  template <class T>
  static DEFINITE_INLINE Vec<T, kDofs> Gradient(const Vec<T, kDofs>& x,
                                                const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    return Kron((Slopes(f, p).psi1 / f.scale / f.lift) * f.w, f.n);  // Eq. 16
  }

  template <class T>
  static DEFINITE_INLINE Classification<T> Classify(const Vec<T, kDofs>& x,
                                                    const Vec<T, kParams>& p) {
    const auto f = Length::FrameOf(x, p[2]);
    return {Select((f.l >= f.InUnits(p[1])) | f.outside, T(0.0), T(1.0)),
            Select(f.outside, T(0.0), T(1.0)), T(0.0)};
  }

  template <Set kSet, Part kPart, class T>
  static DEFINITE_INLINE auto HessianModes(const Vec<T, kDofs>& x, const Vec<T, kParams>& p) {
    if constexpr (kSet == Set::kPrinted) {
      const auto f = Length::PrintedFrameOf(x, p[2]);
      const auto slopes = Slopes(f.l, p[0], p[1], f.l >= p[1]);
      return Length::PrintedModes(f, slopes.psi1, slopes.psi2);
    } else {
      const auto f = Length::FrameOf(x, p[2]);
      const auto slopes = Slopes(f, p);
      return Length::template FrameModes<kPart>(f, slopes.psi1, slopes.psi2);
    }
  }

 private:
  // psi'/unit and psi'', zero where the energy does not act.
  template <class T>
  static DEFINITE_INLINE auto Slopes(const typename Length::template Frame<T>& f,
                                     const Vec<T, kParams>& p) {
    const T eps = f.InUnits(p[1]);
    return Slopes(f.l, p[0], eps, (f.l >= eps) | f.outside);
  }
  template <class T, class Mask>
  static DEFINITE_INLINE auto Slopes(const T& l, const T& k, const T& eps, const Mask& idle) {
    auto slopes = Penalty::Derivatives(l, k, eps);
    slopes.psi1 = Select(idle, T(0.0), slopes.psi1);
    slopes.psi2 = Select(idle, T(0.0), slopes.psi2);
    return slopes;
  }
};

DEFINITE_ENERGY(CollisionSigned<VertexFace, Quadratic>);

}  // namespace definite
