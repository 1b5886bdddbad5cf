#pragma once

// What a scene is made of. SI units: metres, kilograms, seconds, newtons. Vertices have three
// coordinates each, vertex by vertex; z is up.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/kernel.hpp"

namespace definite::scenes {

using Point = std::array<double, 3>;

// Elements of one energy of the registry, such as "strand/stretch/quadratic".
struct Elements {
  std::string energy;
  std::vector<int> vertices;  // those of the stencil for each element
  std::vector<double> p;      // one number for each of the energy's parameters, for each element
};

// What of a pair is remembered from step to step: on which side of each other its primitives began.
enum class Memory {
  kScene,  // the scene knows it: which cable was above
  kPair,   // each pair remembers it from where it last came into reach
  kNone,   // nothing is remembered: an unsigned pair is never penetrating
};

// Pairs of vertex-face or edge-edge that may touch; a pair acts where its primitives, clamped to
// their ends, are nearer than eps.
struct Contacts {
  std::string stencil;        // "edge_edge" or "vertex_face"
  std::string length;         // "signed", "unsigned", "unsigned_frozen", "hybrid"
  std::vector<int> vertices;  // four for each pair
  // For each pair the sign that turns the triple product n.e2 positive where the pair began; 0
  // where the scene cannot know, and the pair has to remember by itself.
  std::vector<int> orientation;
  double k = 0, eps = 0;  // N/m; m
  Memory memory = Memory::kScene;

  std::size_t Size() const { return vertices.size() / 4; }
  std::string Energy() const { return "collision/" + stencil + "/" + length + "/quadratic"; }
};

struct Model {
  std::vector<double> x, v;    // m, m/s
  std::vector<double> mass;    // of each vertex, kg
  std::vector<bool> scripted;  // of each vertex: it moves as the script says
  std::vector<double> script;  // velocities of those until script_end, at rest thereafter, m/s
  double script_end = 0;       // s
  std::vector<double> load;    // a constant force on each coordinate, N
  std::vector<Elements> elastic;
  Contacts contacts;

  int Size() const { return static_cast<int>(mass.size()); }
  int AddVertex(const Point& at, double kilograms, bool is_scripted = false,
                const Point& velocity = {}) {
    x.insert(x.end(), at.begin(), at.end());
    v.insert(v.end(), 3, 0.0);
    load.insert(load.end(), 3, 0.0);
    script.insert(script.end(), velocity.begin(), velocity.end());
    mass.push_back(kilograms);
    scripted.push_back(is_scripted);
    return Size() - 1;
  }
};

// The row of an energy and a filter in double; throws std::runtime_error if there is none.
const KernelRow& KernelOf(const std::string& energy, std::string_view filter);

inline Point At(const std::vector<double>& x, int vertex) {
  const auto at = static_cast<std::size_t>(3 * vertex);
  return {x[at], x[at + 1], x[at + 2]};
}
inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double Dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point Cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace definite::scenes
