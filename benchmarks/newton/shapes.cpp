#include "benchmarks/newton/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace definite::newton {

namespace {

using std::numbers::pi;

double X(double rho, double phi) { return rho * std::cos(phi); }
double Y(double rho, double phi) { return rho * std::sin(phi); }

}  // namespace

Mesh MakeDisk(int rings, const Surface& surface) {
  Mesh mesh;
  const auto first = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  mesh.rest.push_back(surface(0, 0));
  for (int ring = 1; ring <= rings; ++ring) {
    for (int i = 0; i < 6 * ring; ++i) {
      mesh.rest.push_back(surface(static_cast<double>(ring) / rings, pi * i / (3 * ring)));
    }
  }
  const auto add = [&mesh](int a, int b, int c) {
    mesh.elements.insert(mesh.elements.end(), {a, b, c});
  };
  for (int ring = 1; ring <= rings; ++ring) {
    const auto outer = [&](int i) { return first(ring) + i % (6 * ring); };
    const auto inner = [&](int i) {
      return ring == 1 ? 0 : first(ring - 1) + i % (6 * (ring - 1));
    };
    // Each of six sectors has `ring` edges outside and ring - 1 inside.
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < ring; ++i) {
        const int out = sector * ring + i, in = sector * (ring - 1) + i;
        add(outer(out), outer(out + 1), inner(in));
        if (i + 1 < ring) add(inner(in), outer(out + 1), inner(in + 1));
      }
    }
  }
  return mesh;
}

Surface Cap(double angle) {
  return [angle](double rho, double phi) {
    const double radius = std::sin(angle * rho);
    return Point{X(radius, phi), Y(radius, phi), std::cos(angle * rho)};
  };
}

Surface Saddle(double height) {
  return [height](double rho, double phi) {
    const double x = X(rho, phi), y = Y(rho, phi);
    return Point{x, y, height * (x * x - y * y)};
  };
}

Surface Waves(double height, double waves) {
  return [height, waves](double rho, double phi) {
    const double x = X(rho, phi), y = Y(rho, phi);
    return Point{x, y, height * std::sin(waves * x) * std::sin(waves * y)};
  };
}

Surface Peak(double height, double width) {
  return [height, width](double rho, double phi) {
    const double x = X(rho, phi), y = Y(rho, phi), r = std::hypot(x - 0.2, y - 0.1);
    return Point{x, y, height * std::exp(-r * r / (width * width))};
  };
}

Surface Cone(double height) {
  return [height](double rho, double phi) {
    return Point{X(rho, phi), Y(rho, phi), height * (1 - rho)};
  };
}

Surface Star(double depth, int arms) {
  return [depth, arms](double rho, double phi) {
    const double radius = rho * (1 + depth * std::cos(arms * phi));
    return Point{X(radius, phi), Y(radius, phi), 0};
  };
}

Surface Ribbon(double aspect) {
  return [aspect](double rho, double phi) {
    const double along = aspect * X(rho, phi);
    return Point{std::sin(along), Y(rho, phi), std::cos(along)};
  };
}

Mesh MakeBlock(int x, int y, int z) {
  Mesh mesh;
  mesh.size = 4;
  for (int k = 0; k <= z; ++k) {
    for (int j = 0; j <= y; ++j) {
      for (int i = 0; i <= x; ++i) {
        mesh.rest.push_back(
            {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
      }
    }
  }
  const int steps[] = {1, x + 1, (x + 1) * (y + 1)};
  for (int k = 0; k < z; ++k) {
    for (int j = 0; j < y; ++j) {
      for (int i = 0; i < x; ++i) {
        // A tetrahedron for each order in which the axes lead from corner to corner.
        int order[] = {0, 1, 2};
        do {
          int v[4] = {i * steps[0] + j * steps[1] + k * steps[2]};
          for (int axis = 0; axis < 3; ++axis) v[axis + 1] = v[axis] + steps[order[axis]];
          const bool is_even =
              (order[0] < order[1]) ^ (order[1] < order[2]) ^ (order[0] < order[2]);
          if (!is_even) std::swap(v[2], v[3]);
          mesh.elements.insert(mesh.elements.end(), v, v + 4);
        } while (std::ranges::next_permutation(order).found);
      }
    }
  }
  return mesh;
}

}  // namespace definite::newton
