#pragma once

// Configurations on record: those that a simulation met, one a line.
//
// CSV (.csv): lines of settings that begin with #, a head that names the columns, and numbers. The
// columns are x0,y0,z0,x1,... of each vertex, and parameters of the energies that lines differ in;
// the settings are the stencil and parameters that all lines share:
//
//   # stencil=edge_edge k=1000 eps=0.01
//   x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3
//   0,0,0,1,0,0,0.5,-0.5,0.008,0.5,0.5,0.008
//
// JSON lines (.jsonl): objects with x, an array of the same numbers, and the same names; the first
// may lack x, and is then the settings of all:
//
//   {"stencil": "edge_edge", "k": 1000, "eps": 0.01}
//   {"x": [0, 0, 0, 1, 0, 0, 0.5, -0.5, 0.008, 0.5, 0.5, 0.008]}
//
// Numbers are decimal, or, in CSV, hex floats as 0x1.8p-3.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/harness/sampling/distribution.hpp"

namespace definite {

// What is wrong with a file; the message names it, and the line.
class RecordedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Recorded {
  std::string stencil;
  int dofs = 0;
  std::vector<std::string> parameters;  // that the file says something of
  std::vector<double> x;                // dofs numbers of each configuration
  std::vector<double> p;                // parameters.size() numbers of each
  std::vector<std::uint32_t> lines;     // of the file, from 1: where each configuration stands
  std::uint64_t digest = 0;             // changes with any of the above but the lines

  std::uint64_t Size() const { return lines.size(); }
  // Configuration `index` in the layout of a distribution; beyond the last it goes round again.
  void Take(const DrawTarget& target, std::uint64_t index, double* x_out, double* p_out) const;
};

// x0, y0, z0, x1, ...
std::vector<std::string> CoordinateNames(int dofs, int dimension);

// Whether a name is that of such a file: it ends in .csv or .jsonl.
bool IsRecorded(std::string_view name);

// Throws RecordedError.
Recorded ReadRecorded(const std::string& path);

}  // namespace definite
