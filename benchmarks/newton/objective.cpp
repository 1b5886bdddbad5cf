#include "benchmarks/newton/objective.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace definite::newton {

double Terms::Sum() const {
  double sum = 0;
  for (const double term : of) sum += term;
  return sum;
}

double Terms::LessThose(const Terms& before) const {
  double sum = 0;
  for (std::size_t i = 0; i < of.size(); ++i) sum += of[i] - before.of[i];
  return sum;
}

Objective::Objective(const Problem& problem)
    : problem_(problem), number_(problem.fixed.size(), -1) {
  for (std::size_t i = 0; i < number_.size(); ++i) {
    if (problem.fixed[i]) continue;
    number_[i] = free_++;
    coordinates_.push_back(static_cast<int>(i));
  }
}

void Objective::SetInertia(std::vector<double> weight, std::vector<double> predicted) {
  weight_ = std::move(weight);
  predicted_ = std::move(predicted);
}

std::vector<double> Objective::Gather(const std::vector<double>& x) const {
  const auto d = static_cast<std::size_t>(problem_.energy->dimension);
  std::vector<double> gathered;
  gathered.reserve(problem_.elements.size() * d);
  for (const int vertex : problem_.elements) {
    const auto first = x.begin() + static_cast<long>(d) * vertex;
    gathered.insert(gathered.end(), first, first + static_cast<long>(d));
  }
  return gathered;
}

Terms Objective::ValueAt(const std::vector<double>& x) const {
  const EnergyRow& energy = *problem_.energy;
  const std::vector<double> gathered = Gather(x);
  const int elements = problem_.Elements();
  Terms terms;
  terms.of.resize(static_cast<std::size_t>(elements));
  energy.value(gathered.data(), problem_.p.data(), terms.of.data(), elements);
  // Outside the domain the value is 0, and would pass for the least.
  for (int e = 0; e < elements; ++e) {
    if (terms.of[static_cast<std::size_t>(e)] != 0) continue;
    double classification[3];
    energy.classify(gathered.data() + e * energy.dofs,
                    problem_.p.data() + e * static_cast<long>(energy.parameters.size()),
                    classification, 1);
    terms.in_domain = terms.in_domain && classification[1] == 1;
  }
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double off = x[i] - predicted_[i];
    terms.of.push_back(weight_[i] / 2 * off * off);
  }
  return terms;
}

Vector Objective::GradientAt(const std::vector<double>& x) const {
  const EnergyRow& energy = *problem_.energy;
  const std::vector<double> gathered = Gather(x);
  std::vector<double> forces(gathered.size());
  energy.gradient(gathered.data(), problem_.p.data(), forces.data(), problem_.Elements());
  Vector gradient = Vector::Zero(free_);
  const int d = energy.dimension;
  for (std::size_t i = 0; i < problem_.elements.size(); ++i) {
    for (int k = 0; k < d; ++k) {
      const int n = NumberOf(problem_.elements[i] * d + k);
      if (n >= 0)
        gradient[n] += forces[i * static_cast<std::size_t>(d) + static_cast<std::size_t>(k)];
    }
  }
  if (!weight_.empty()) {
    for (int n = 0; n < free_; ++n) {
      const auto i = static_cast<std::size_t>(coordinates_[static_cast<std::size_t>(n)]);
      gradient[n] += weight_[i] * (x[i] - predicted_[i]);
    }
  }
  return gradient;
}

double Objective::CharacteristicForce() const {
  const int d = problem_.energy->dimension, size = problem_.Size();
  const auto parameters = problem_.energy->parameters.size();
  std::vector<double> force(problem_.fixed.size() / static_cast<std::size_t>(d));
  for (int e = 0; e < problem_.Elements(); ++e) {
    const double* const p = &problem_.p[static_cast<std::size_t>(e) * parameters];
    // Row k of R is the gradient of the shape function of vertex k + 1; all sum to 0.
    for (int vertex = 0; vertex < size; ++vertex) {
      double square = 0;
      for (int j = 0; j < d; ++j) {
        double slope = 0;
        for (int k = 0; k < d; ++k) {
          if (vertex == 0) slope -= p[k * d + j];
          if (vertex == k + 1) slope = p[k * d + j];
        }
        square += slope * slope;
      }
      force[static_cast<std::size_t>(
          problem_.elements[static_cast<std::size_t>(e * size + vertex)])] +=
          p[d * d] * std::sqrt(square);
    }
  }
  double most = 0;
  for (const int i : coordinates_) most = std::max(most, force[static_cast<std::size_t>(i / d)]);
  return most;
}

template <class Fill>
void Hessian::ForTiles(Fill fill) const {
  const long lanes = row_.lanes, elements = problem_.Elements();
  // What fills up the last tile is its last element once more, and is not added.
  for (long at = 0; at < tiles_ * lanes; ++at) {
    fill(std::min(at, elements - 1), at / lanes * lanes, at % lanes);
  }
}

Hessian::Hessian(const Objective& objective, const KernelRow& row)
    : objective_(objective),
      problem_(objective.Of()),
      row_(row),
      tiles_((problem_.Elements() + row.lanes - 1) / row.lanes) {
  const EnergyRow& energy = *problem_.energy;
  const auto numbers = [&](std::size_t each) {
    return static_cast<std::size_t>(tiles_ * row.lanes) * each;
  };
  x_.Resize(numbers(static_cast<std::size_t>(energy.dofs)));
  p_.Resize(numbers(energy.parameters.size()));
  packed_.Resize(numbers(static_cast<std::size_t>(row.outputs)));
  const auto parameters = static_cast<long>(energy.parameters.size());
  ForTiles([&](long e, long tile, long lane) {
    for (long k = 0; k < parameters; ++k) {
      p_.Data()[tile * parameters + k * row.lanes + lane] =
          problem_.p[static_cast<std::size_t>(e * parameters + k)];
    }
  });

  const int d = energy.dimension;
  std::vector<std::pair<int, int>> entries;  // row and column of each packed entry; -1 if fixed
  for (int e = 0; e < problem_.Elements(); ++e) {
    const auto number_of = [&](int dof) {
      const int vertex = problem_.elements[static_cast<std::size_t>(e * problem_.Size() + dof / d)];
      return objective.NumberOf(vertex * d + dof % d);
    };
    for (int i = 0; i < energy.dofs; ++i) {
      for (int j = i; j < energy.dofs; ++j) {
        const auto [low, high] = std::minmax({number_of(i), number_of(j)});
        entries.emplace_back(low < 0 ? -1 : high, low);
      }
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  for (int n = 0; n < objective.Free(); ++n) triplets.emplace_back(n, n, 0);
  for (const auto& [r, c] : entries) {
    if (r >= 0) triplets.emplace_back(r, c, 0);
  }
  matrix_.resize(objective.Free(), objective.Free());
  matrix_.setFromTriplets(triplets.begin(), triplets.end());
  const auto place = [this](int r, int c) {
    const int* const inner = matrix_.innerIndexPtr();
    const int* const begin = inner + matrix_.outerIndexPtr()[c];
    const int* const end = inner + matrix_.outerIndexPtr()[c + 1];
    return static_cast<long>(std::lower_bound(begin, end, r) - inner);
  };
  for (const auto& [r, c] : entries) places_.push_back(r < 0 ? -1 : place(r, c));
  for (int n = 0; n < objective.Free(); ++n) diagonal_.push_back(place(n, n));
}

void Hessian::Evaluate(const std::vector<double>& x) {
  const long dofs = problem_.energy->dofs, d = problem_.energy->dimension;
  ForTiles([&](long e, long tile, long lane) {
    for (long i = 0; i < dofs; ++i) {
      const long vertex = problem_.elements[static_cast<std::size_t>(e * problem_.Size() + i / d)];
      x_.Data()[tile * dofs + i * row_.lanes + lane] =
          x[static_cast<std::size_t>(vertex * d + i % d)];
    }
  });
  row_.run(x_.Data(), p_.Data(), packed_.Data(), tiles_);
}

void Hessian::Assemble() {
  double* const values = matrix_.valuePtr();
  std::fill_n(values, matrix_.nonZeros(), 0.0);
  const long* place = places_.data();
  for (long e = 0; e < problem_.Elements(); ++e) {
    for (int k = 0; k < row_.outputs; ++k, ++place) {
      if (*place >= 0) values[*place] += Entry(e, k);
    }
  }
  const std::vector<double>& weight = objective_.InertiaWeight();
  if (weight.empty()) return;
  for (std::size_t n = 0; n < diagonal_.size(); ++n) {
    values[diagonal_[n]] += weight[static_cast<std::size_t>(objective_.FreeCoordinates()[n])];
  }
}

}  // namespace definite::newton
