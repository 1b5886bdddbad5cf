#include "scenes/step.hpp"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "benchmarks/harness/clock.hpp"

namespace definite::scenes {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kOfEps = 1e-9;   // Newton ends where no vertex moves farther, in units of eps
constexpr double kArmijo = 1e-4;  // the share of the predicted decrease that a step must bring
constexpr int kHalvings = 30;
constexpr double kStages[] = {0, 0.25, 0.5, 0.75, 1};  // of "progressive"

// Vertices of each element of an energy, its degrees of freedom gathered.
struct Gathered {
  const EnergyRow* energy;
  long count;
  std::size_t dofs;
  std::vector<double> x;
  std::vector<int> rows;  // the coordinate of each degree of freedom
};

Gathered Gather(const Elements& elements, const std::vector<double>& x) {
  Gathered g{KernelOf(elements.energy, "none").energy, 0, 0, {}, {}};
  g.dofs = static_cast<std::size_t>(g.energy->dofs);
  g.count = static_cast<long>(3 * elements.vertices.size() / g.dofs);
  for (const int vertex : elements.vertices) {
    for (int i = 0; i < 3; ++i) {
      g.rows.push_back(3 * vertex + i);
      g.x.push_back(x[static_cast<std::size_t>(3 * vertex + i)]);
    }
  }
  return g;
}

double ValueOf(const Elements& elements, const std::vector<double>& x) {
  if (elements.vertices.empty()) return 0;
  const Gathered g = Gather(elements, x);
  std::vector<double> values(static_cast<std::size_t>(g.count));
  g.energy->value(g.x.data(), elements.p.data(), values.data(), g.count);
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

void AddGradient(const Elements& elements, const std::vector<double>& x, Vector& gradient) {
  if (elements.vertices.empty()) return;
  const Gathered g = Gather(elements, x);
  std::vector<double> out(g.rows.size());
  g.energy->gradient(g.x.data(), elements.p.data(), out.data(), g.count);
  for (std::size_t i = 0; i < out.size(); ++i) gradient[g.rows[i]] += out[i];
}

// scale times the Hessians of a filter, both halves.
void AddHessian(const Elements& elements, std::string_view filter, const std::vector<double>& x,
                double scale, Triplets& triplets, double& seconds) {
  if (elements.vertices.empty()) return;
  const Gathered g = Gather(elements, x);
  const KernelRow& row = KernelOf(elements.energy, filter);
  const auto numbers = static_cast<std::size_t>(row.outputs);
  std::vector<double> packed(numbers * static_cast<std::size_t>(g.count));
  const double start = WallSeconds();
  row.run(g.x.data(), elements.p.data(), packed.data(), g.count);
  seconds += WallSeconds() - start;
  for (std::size_t e = 0; e < static_cast<std::size_t>(g.count); ++e) {
    const int* const rows = &g.rows[e * g.dofs];
    const double* entry = &packed[e * numbers];
    for (std::size_t i = 0; i < g.dofs; ++i) {
      for (std::size_t j = i; j < g.dofs; ++j) {
        const double value = scale * *entry++;
        triplets.emplace_back(rows[i], rows[j], value);
        if (i != j) triplets.emplace_back(rows[j], rows[i], value);
      }
    }
  }
}

Matrix FromTriplets(int size, const Triplets& triplets) {
  Matrix matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

// The coordinates that are solved for, by their number in the reduced system; -1 if scripted.
std::vector<int> FreeNumbers(const Model& model) {
  std::vector<int> number(3 * static_cast<std::size_t>(model.Size()), -1);
  int next = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (!model.scripted[i / 3]) number[i] = next++;
  }
  return number;
}

// One step in the making.
class Stepping {
 public:
  Stepping(const Model& model, const Method& method, double dt, State& state)
      : model_(model),
        method_(method),
        dt_(dt),
        state_(state),
        size_(3 * model.Size()),
        number_(FreeNumbers(model)),
        free_(1 + *std::max_element(number_.begin(), number_.end())),
        x_(state.x),
        left_(Vector::Zero(size_)) {
    const double moving = std::clamp(model.script_end - state.time, 0.0, dt);
    // A time left over by rounding is no motion.
    if (moving > 1e-9 * dt) {
      for (int i = 0; i < size_; ++i) left_[i] = moving * model.script[Index(i)];
    }
  }

  StepReport Run() {
    if (method_.line_search) MoveScripted();
    for (int i = 0; i < method_.iterations && report_.solved; ++i) {
      ++report_.newton_iterations;
      if (!Iterate(i == 0)) break;
    }
    for (int i = 0; i < size_; ++i) {
      const double v = (x_[Index(i)] - state_.x[Index(i)]) / dt_;
      if (!std::isfinite(v)) report_.solved = false;
      state_.v[Index(i)] = v;
    }
    state_.x = x_;
    state_.time += dt_;
    return report_;
  }

 private:
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }
  double Mass(int i) const { return model_.mass[Index(i / 3)]; }

  void MoveScripted() {
    for (int i = 0; i < size_; ++i) {
      if (number_[Index(i)] < 0) x_[Index(i)] += left_[i];
    }
    left_.setZero();
  }

  // False if it has converged or cannot go on.
  bool Iterate(bool is_first) {
    const Elements pairs = ContactsAt(model_.contacts, x_, state_.memory);
    if (is_first) report_.contacts = pairs.vertices.size() / 4;
    Triplets elastic;
    for (const Elements& term : model_.elastic) {
      AddHessian(term, method_.elastic_filter, x_, 1, elastic, report_.kernel_seconds);
    }
    const Matrix stiffness = FromTriplets(size_, elastic);
    if (is_first) damping_ = method_.rayleigh * stiffness;
    Matrix base = stiffness + (1 / dt_) * (method_.rayleigh * stiffness);
    Vector residual = Vector::Zero(size_);
    for (const Elements& term : model_.elastic) AddGradient(term, x_, residual);
    AddGradient(pairs, x_, residual);
    Vector moved(size_);
    for (int i = 0; i < size_; ++i) {
      moved[i] = x_[Index(i)] - state_.x[Index(i)];
      residual[i] += Mass(i) / (dt_ * dt_) * (moved[i] - dt_ * state_.v[Index(i)]);
      residual[i] -= model_.load[Index(i)];
    }
    residual += (1 / dt_) * (damping_ * moved);
    Triplets inertia;
    for (int i = 0; i < size_; ++i) inertia.emplace_back(i, i, Mass(i) / (dt_ * dt_));
    base += FromTriplets(size_, inertia);
    Vector step(size_);
    if (!Solve(base, pairs, residual, step)) return false;
    double length = 1;
    if (method_.line_search) length = SearchLine(residual, step);
    double farthest = 0;
    for (int i = 0; i < size_; ++i) {
      x_[Index(i)] += length * step[i];
      farthest = std::max(farthest, std::abs(step[i]));
    }
    left_.setZero();
    if (length == 0) report_.converged = farthest <= 1e-3 * model_.contacts.eps;
    return length > 0 && farthest > kOfEps * model_.contacts.eps;
  }

  // base + the contacts' Hessian as the filter has it; false if it cannot be solved with.
  bool Solve(const Matrix& base, const Elements& pairs, const Vector& residual, Vector& step) {
    if (method_.filter == "on_demand" || method_.filter == "progressive") {
      bool is_first = true;
      for (const double s : kStages) {
        if (method_.filter == "on_demand" && s > 0 && s < 1) continue;
        Triplets triplets;
        if (s < 1) AddHessian(pairs, "none", x_, 1 - s, triplets, report_.kernel_seconds);
        if (s > 0) AddHessian(pairs, method_.fallback, x_, s, triplets, report_.kernel_seconds);
        const bool solved = SolveWith(base + FromTriplets(size_, triplets), residual, step);
        if (is_first) report_.first_negative = report_.negative_pivots;
        is_first = false;
        if (s == 1) return solved;
        if (solved && report_.negative_pivots == 0) return true;
      }
    }
    Triplets triplets;
    AddHessian(pairs, method_.filter, x_, 1, triplets, report_.kernel_seconds);
    const bool solved = SolveWith(base + FromTriplets(size_, triplets), residual, step);
    report_.first_negative = report_.negative_pivots;
    return solved;
  }

  bool SolveWith(const Matrix& matrix, const Vector& residual, Vector& step) {
    Triplets reduced;
    Vector right(free_);
    for (int i = 0; i < size_; ++i) {
      if (number_[Index(i)] >= 0) right[number_[Index(i)]] = -residual[i];
    }
    for (int column = 0; column < matrix.outerSize(); ++column) {
      const int c = number_[Index(column)];
      for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
        const int r = number_[Index(static_cast<int>(entry.row()))];
        if (r < 0) continue;
        if (c >= 0) {
          reduced.emplace_back(r, c, entry.value());
        } else {
          right[r] -= entry.value() * left_[column];
        }
      }
    }
    const Matrix a = FromTriplets(free_, reduced);
    Vector solution;
    if (method_.solver == Solver::kLdlt) {
      Eigen::SimplicialLDLT<Matrix> ldlt(a);
      ++report_.factorizations;
      report_.solved = ldlt.info() == Eigen::Success;
      if (!report_.solved) return false;
      report_.negative_pivots = static_cast<int>((ldlt.vectorD().array() < 0).count());
      solution = ldlt.solve(right);
    } else {
      Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> cg(a);
      solution = cg.solve(right);
      report_.solver_iterations += static_cast<int>(cg.iterations());
    }
    report_.solved = solution.allFinite();
    if (!report_.solved) return false;
    for (int i = 0; i < size_; ++i) {
      const int n = number_[Index(i)];
      step[i] = n >= 0 ? solution[n] : left_[i];
    }
    return true;
  }

  // What backward Euler minimises, J.
  double Objective(const std::vector<double>& x) {
    SideMemory memory = state_.memory;  // a trial is not remembered
    double value = ValueOf(ContactsAt(model_.contacts, x, memory), x);
    for (const Elements& term : model_.elastic) value += ValueOf(term, x);
    Vector moved(size_);
    for (int i = 0; i < size_; ++i) {
      moved[i] = x[Index(i)] - state_.x[Index(i)];
      const double off = moved[i] - dt_ * state_.v[Index(i)];
      value += Mass(i) / (2 * dt_ * dt_) * off * off - model_.load[Index(i)] * x[Index(i)];
    }
    return value + moved.dot(damping_ * moved) / (2 * dt_);
  }

  // How far along `step` to go: 1, 1/2, ... or 0 if nothing helps.
  double SearchLine(const Vector& residual, const Vector& step) {
    const double before = Objective(x_), slope = residual.dot(step);
    double length = 1;
    for (int i = 0; i < kHalvings; ++i, length /= 2) {
      std::vector<double> trial = x_;
      for (int k = 0; k < size_; ++k) trial[Index(k)] += length * step[k];
      if (Objective(trial) <= before + kArmijo * length * std::min(slope, 0.0)) return length;
    }
    return 0;
  }

  const Model& model_;
  const Method& method_;
  const double dt_;
  State& state_;
  const int size_;
  const std::vector<int> number_;
  const int free_;
  std::vector<double> x_;
  Vector left_;     // how far scripted vertices have to go yet
  Matrix damping_;  // C, of the beginning of the step
  StepReport report_;
};

}  // namespace

StepReport Advance(const Model& model, const Method& method, double dt, State& state) {
  return Stepping(model, method, dt, state).Run();
}

Assembled Assemble(const Model& model, const Method& method, const std::vector<double>& x,
                   SideMemory& memory) {
  const int size = 3 * model.Size();
  const Elements pairs = ContactsAt(model.contacts, x, memory);
  Vector gradient = Vector::Zero(size);
  Triplets triplets;
  double seconds = 0;
  Assembled a;
  a.value = ValueOf(pairs, x);
  AddGradient(pairs, x, gradient);
  AddHessian(pairs, method.filter, x, 1, triplets, seconds);
  for (const Elements& term : model.elastic) {
    a.value += ValueOf(term, x);
    AddGradient(term, x, gradient);
    AddHessian(term, method.elastic_filter, x, 1, triplets, seconds);
  }
  a.gradient.assign(gradient.begin(), gradient.end());
  const Eigen::MatrixXd dense = FromTriplets(size, triplets);
  a.hessian.assign(dense.data(), dense.data() + dense.size());
  return a;
}

bool IsFilter(std::string_view name) {
  if (name == "on_demand" || name == "progressive") return true;
  return std::ranges::any_of(AllKernels(), [&](const KernelRow& row) {
    return row.filter == name && row.scalar == "f64" && row.energy->name.starts_with("collision/");
  });
}

}  // namespace definite::scenes
