#include "benchmarks/newton/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace definite::newton {

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
double Dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point Cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double Norm(const Point& a) { return std::sqrt(Dot(a, a)); }

double MeasureOf(const Mesh& mesh, int element) {
  const int* const v = mesh.Element(element);
  const Point a = mesh.At(v[1]) - mesh.At(v[0]), b = mesh.At(v[2]) - mesh.At(v[0]);
  const Point normal = Cross(a, b);
  return mesh.size == 3 ? Norm(normal) / 2 : Dot(normal, mesh.At(v[3]) - mesh.At(v[0])) / 6;
}

namespace {

// How many sets of `count` vertices are together in an element.
int CountFaces(const Mesh& mesh, int count) {
  std::vector<std::array<int, 3>> faces;
  for (int e = 0; e < mesh.Elements(); ++e) {
    std::vector<int> v(mesh.Element(e), mesh.Element(e) + mesh.size);
    std::ranges::sort(v);
    std::vector<int> chosen(v.size());
    std::fill_n(chosen.begin(), count, 1);
    do {
      std::array<int, 3> face{-1, -1, -1};
      std::size_t next = 0;
      for (std::size_t i = 0; i < v.size(); ++i) {
        if (chosen[i] != 0) face[next++] = v[i];
      }
      faces.push_back(face);
    } while (std::ranges::prev_permutation(chosen).found);
  }
  std::ranges::sort(faces);
  return static_cast<int>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

}  // namespace

int EulerCharacteristic(const Mesh& mesh) {
  const int surfaces = mesh.Vertices() - CountFaces(mesh, 2) + CountFaces(mesh, 3);
  return mesh.size == 3 ? surfaces : surfaces - mesh.Elements();
}

}  // namespace definite::newton
