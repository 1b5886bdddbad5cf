#pragma once

// What is minimised: the energy of a mesh's elements over the coordinates that are free, and over
// time, if asked for, with inertia.

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/newton/mesh.hpp"
#include "kernels/kernel.hpp"

namespace definite::newton {

// Backward Euler: each step minimises sum m/(2 dt^2) |x - predicted|^2 + psi, where predicted is
// x0 + dt v + dt^2 g.
struct Motion {
  int steps;
  double dt;                    // s
  std::vector<double> mass;     // of each vertex
  std::vector<double> gravity;  // of each coordinate axis
};

struct Problem {
  std::string name;
  const EnergyRow* energy = nullptr;
  std::vector<int> elements;  // their vertices, one after another
  std::vector<double> p;      // their parameters, likewise
  std::vector<double> start;  // coordinates, vertex by vertex; those that are fixed keep theirs
  std::vector<bool> fixed;    // of each coordinate
  std::optional<Motion> motion;

  int Size() const { return energy->dofs / energy->dimension; }  // vertices of an element
  int Elements() const { return static_cast<int>(elements.size()) / Size(); }
};

// R and the energy's default stiffnesses times the area or volume, for an element with `rest` as
// its vertices.
void AppendParameters(const EnergyRow& energy, const double* rest, std::vector<double>& p);

// A disk laid out in the plane from Tutte's embedding. One vertex is fixed, another held on the x
// axis through it: layouts that are turned or moved are the same. By an energy that ignores scale
// larger ones are, too, and the other is fixed as well.
Problem ParameterizeDisk(std::string name, const EnergyRow& energy, const Mesh& disk);

// Tetrahedra with their rest shape, all free, at rest.
Problem SolidAtRest(std::string name, const EnergyRow& energy, const Mesh& mesh);

}  // namespace definite::newton
