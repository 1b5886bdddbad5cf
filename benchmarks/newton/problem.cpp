#include "benchmarks/newton/problem.hpp"

#include <Eigen/Dense>
#include <utility>

#include "benchmarks/newton/layout.hpp"

namespace definite::newton {

void AppendParameters(const EnergyRow& energy, const double* rest, std::vector<double>& p) {
  const int d = energy.dimension;
  Eigen::MatrixXd edges(d, d);
  for (int k = 0; k < d; ++k) {
    for (int i = 0; i < d; ++i) edges(i, k) = rest[(k + 1) * d + i] - rest[i];
  }
  const Eigen::MatrixXd inverse = edges.inverse();
  for (int k = 0; k < d; ++k) {
    for (int j = 0; j < d; ++j) p.push_back(inverse(k, j));
  }
  const double measure = edges.determinant() / (d == 2 ? 2 : 6);
  for (std::size_t k = static_cast<std::size_t>(d * d); k < energy.parameters.size(); ++k) {
    p.push_back(energy.parameters[k].value * measure);
  }
}

namespace {

// Whether a triangle twice as large is at rest as well.
bool IgnoresScale(const EnergyRow& energy) {
  const double rest[] = {0, 0, 1, 0, 0, 1}, larger[] = {0, 0, 2, 0, 0, 2};
  std::vector<double> p;
  AppendParameters(energy, rest, p);
  double value = 0;
  energy.value(larger, p.data(), &value, 1);
  return value == 0;
}

}  // namespace

Problem ParameterizeDisk(std::string name, const EnergyRow& energy, const Mesh& disk) {
  Problem problem;
  problem.name = std::move(name);
  problem.energy = &energy;
  problem.elements = disk.elements;
  for (int e = 0; e < disk.Elements(); ++e) {
    AppendParameters(energy, FlattenTriangle(disk, e).data(), problem.p);
  }
  const Embedding embedding = EmbedDisk(disk);
  for (const PlanePoint& point : embedding.points) {
    problem.start.insert(problem.start.end(), point.begin(), point.end());
  }
  problem.fixed.assign(problem.start.size(), false);
  const auto left = static_cast<std::size_t>(2 * embedding.left);
  problem.fixed[left] = problem.fixed[left + 1] = true;
  const auto right = static_cast<std::size_t>(2 * embedding.right);
  problem.fixed[right] = IgnoresScale(energy);
  problem.fixed[right + 1] = true;
  return problem;
}

Problem SolidAtRest(std::string name, const EnergyRow& energy, const Mesh& mesh) {
  Problem problem;
  problem.name = std::move(name);
  problem.energy = &energy;
  problem.elements = mesh.elements;
  for (const Point& point : mesh.rest) {
    problem.start.insert(problem.start.end(), point.begin(), point.end());
  }
  for (int e = 0; e < mesh.Elements(); ++e) {
    std::vector<double> rest;
    for (int i = 0; i < mesh.size; ++i) {
      const Point& point = mesh.At(mesh.Element(e)[i]);
      rest.insert(rest.end(), point.begin(), point.end());
    }
    AppendParameters(energy, rest.data(), problem.p);
  }
  problem.fixed.assign(problem.start.size(), false);
  return problem;
}

}  // namespace definite::newton
