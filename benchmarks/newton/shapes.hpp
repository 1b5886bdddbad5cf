#pragma once

// Meshes made by rule: disks on curved surfaces, and blocks of tetrahedra.

#include <functional>

#include "benchmarks/newton/mesh.hpp"

namespace definite::newton {

// A surface over the unit disk: where (rho, phi) lies in space.
using Surface = std::function<Point(double rho, double phi)>;

// 6 r vertices on ring r = 1 ... rings, and one in the middle.
Mesh MakeDisk(int rings, const Surface& surface);

// Of the unit sphere, all within `angle` of a pole; angle < pi.
Surface Cap(double angle);
// z = height (x^2 - y^2).
Surface Saddle(double height);
// Crests over the plane: z = height sin(waves x) sin(waves y).
Surface Waves(double height, double waves);
// z = height exp(-(r / width)^2), r from the point (0.2, 0.1): off the middle, for a surface with
// symmetry may be laid out with it, in a saddle point.
Surface Peak(double height, double width);
// z = height (1 - rho): flat but for its tip.
Surface Cone(double height);
// In the plane, with `arms` arms: radius 1 + depth cos(arms phi).
Surface Star(double depth, int arms);
// `aspect` times as long as wide, rolled about its short axis with radius 1.
Surface Ribbon(double aspect);

// Cubes of edge 1 from the origin on, each cut into six tetrahedra about its diagonal.
Mesh MakeBlock(int x, int y, int z);

}  // namespace definite::newton
