#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "reference/energy.hpp"
#include "reference/penalties.hpp"
#include "reference/stencils.hpp"

namespace definite::reference {

// The distance u of a vertex to the line of an edge, negative if the side is; 0 counts as positive.
// p = (k, eps, side). Domain: the edge has a length, u > 0.
struct UnsignedVertexEdge {
  static std::string Name() { return VertexEdge::Name() + "/unsigned"; }
  static constexpr int kDofs = VertexEdge::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 6;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    const Edges<S> e = VertexEdge::EdgesOf(x);
    return OnSide(DistanceToLine(e.e2, e.e0), p[2]);
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T*, const T* p) {
    return OnSide(DistanceToLine(Block(c, 1), Block(c, 0)), p[2]);
  }
  // The edge, and the vector from its closest point, whose place on it is frozen, to the vertex.
  template <class S, class T>
  static std::array<S, 6> FrameAt(const S* x, const T* at, const T*) {
    const Edges<T> frozen = VertexEdge::EdgesOf(at);
    const T be = Dot(frozen.e2, frozen.e0) / Dot(frozen.e0, frozen.e0);
    const Edges<S> e = VertexEdge::EdgesOf(x);
    const Vec3<S> r = e.e2 - be * e.e0;
    return {e.e0.x, e.e0.y, e.e0.z, r.x, r.y, r.z};
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    const Edges<T> e = VertexEdge::EdgesOf(x);
    return Norm(e.e0) > 0 && DistanceToLine(e.e2, e.e0) > 0;
  }
  template <class T>
  static double Conditioning(const T* x, const T*, const T& margin) {
    const Edges<T> e = VertexEdge::EdgesOf(x);
    return Nearness(std::min(DistanceToLine(e.e2, e.e0), margin), e);
  }
};

// The distance u of two vertices, negative if the side is; 0 counts as positive. p = (k, eps,
// side). Domain: u > 0.
struct UnsignedVertexVertex {
  static std::string Name() { return VertexVertex::Name() + "/unsigned"; }
  static constexpr int kDofs = VertexVertex::kDofs;
  static constexpr int kParams = 3;
  static constexpr int kFrameDofs = 3;

  template <class S, class T>
  static S Length(const S* x, const T* p) {
    return OnSide(Norm(VertexVertex::EdgesOf(x).e2), p[2]);
  }
  template <class S, class T>
  static S FrameLength(const S* c, const T*, const T* p) {
    return OnSide(Norm(Block(c, 0)), p[2]);
  }
  template <class S, class T>
  static std::array<S, 3> FrameAt(const S* x, const T*, const T*) {
    const Vec3<S> d = VertexVertex::EdgesOf(x).e2;
    return {d.x, d.y, d.z};
  }
  template <class T>
  static bool InDomain(const T* x, const T*) {
    return Norm(VertexVertex::EdgesOf(x).e2) > 0;
  }
  template <class T>
  static double Conditioning(const T* x, const T*, const T& margin) {
    return Nearness(margin, VertexVertex::EdgesOf(x));
  }
};

DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexEdge, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexEdge, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexEdge, LogBarrier>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexVertex, Quadratic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexVertex, Cubic>);
DEFINITE_REFERENCE_ENERGY(PenaltyOf<UnsignedVertexVertex, LogBarrier>);

}  // namespace definite::reference
