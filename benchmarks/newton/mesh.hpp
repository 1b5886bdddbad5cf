#pragma once

// Triangles in space and tetrahedra, at rest.

#include <array>
#include <vector>

namespace definite::newton {

using Point = std::array<double, 3>;

Point operator+(const Point& a, const Point& b);
Point operator-(const Point& a, const Point& b);
Point operator*(double s, const Point& a);
double Dot(const Point& a, const Point& b);
Point Cross(const Point& a, const Point& b);
double Norm(const Point& a);

struct Mesh {
  int size = 3;  // vertices of an element: 3 or 4
  std::vector<Point> rest;
  std::vector<int> elements;  // one after another

  int Vertices() const { return static_cast<int>(rest.size()); }
  int Elements() const { return static_cast<int>(elements.size()) / size; }
  const int* Element(int e) const { return elements.data() + e * size; }
  const Point& At(int vertex) const { return rest[static_cast<std::size_t>(vertex)]; }
};

// The area of a triangle, or the volume of a tetrahedron, negative where it is inverted.
double MeasureOf(const Mesh& mesh, int element);

// Vertices less edges plus triangles less tetrahedra.
int EulerCharacteristic(const Mesh& mesh);

}  // namespace definite::newton
