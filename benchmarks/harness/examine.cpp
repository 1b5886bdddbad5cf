#include "benchmarks/harness/examine.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

#include "benchmarks/harness/neighbours.hpp"
#include "benchmarks/harness/sampling/batch.hpp"

namespace definite {

namespace {

using reference::Quad;

constexpr double kDegraded = 1e-10;        // relative error beyond which a filter is degraded
constexpr double kDoubt = 0.1;             // of a bound: beyond it double precision does not decide
constexpr double kIllConditioned = 1e-10;  // u |H|/|P| beyond which it does not either
constexpr double kGrowth = 4;              // |F| > kGrowth |H| counts as degraded

template <class T>
double NormOf(const reference::Matrix<T>& m) {
  return static_cast<double>(reference::FrobeniusNorm(m));
}

// |f - m|, the differences taken in T.
template <class T>
double DistanceTo(Packed f, const reference::Matrix<T>& m) {
  T sum = 0;
  std::size_t k = 0;
  for (int i = 0; i < m.rows; ++i) {
    for (int j = i; j < m.rows; ++j) {
      const T d = T(f[k++]) - m(i, j);
      sum += (i == j ? 1 : 2) * d * d;
    }
  }
  using std::sqrt;
  return static_cast<double>(sqrt(sum));
}

// |f - m| / |m|, where 0/0 is 0.
template <class T>
double RelativeError(Packed f, const reference::Matrix<T>& m) {
  const double distance = DistanceTo(f, m);
  return distance == 0 ? 0 : distance / NormOf(m);
}

template <class T>
std::vector<double> ToPacked(const reference::Matrix<T>& m) {
  std::vector<double> a;
  for (int i = 0; i < m.rows; ++i) {
    for (int j = i; j < m.rows; ++j) a.push_back(static_cast<double>(m(i, j)));
  }
  return a;
}

double Norm(std::span<const double> v) {
  double sum = 0;
  for (double a : v) sum += a * a;
  return std::sqrt(sum);
}

// 1 where nothing had to change and nothing did.
double Excess(double change, double least_change) {
  return change == 0 && least_change == 0 ? 1 : change / least_change;
}

const KernelRow* NearestOf(const EnergyRow& energy, std::span<const KernelRow* const> rows) {
  const bool judged =
      std::ranges::any_of(rows, [](const KernelRow* row) { return row->filter == "nearest"; });
  const KernelRow* const fast = judged ? nullptr : FindKernel(energy.name + "/nearest/f64x8");
  return fast ? fast : FindKernel(energy.name + "/numeric/f64");
}

// How many eigenvalues of a are clearly positive.
long PositiveCount(Packed a) {
  const double threshold = kRatioBound * PackedRows(a) * kUnit * FrobeniusNorm(a);
  return std::ranges::count_if(Eigenvalues(a), [&](double v) { return v > threshold; });
}

}  // namespace

// The definitions of the filters at one configuration, each computed once for all rows.
struct Examiner::Definitions {
  Definitions(const EnergyRow& row, const reference::Energy<double>& energy,
              const reference::Energy<Quad>& quad_energy, const double* x, const double* p)
      : row_(row), energy_(energy), quad_energy_(quad_energy), x_(x), p_(p) {}

  const reference::Matrix<double>& Of(const reference::Filter<double>& filter) {
    auto [at, is_new] = matrices_.try_emplace(&filter);
    if (is_new) {
      if (!truth_) truth_.emplace(energy_, x_, p_);
      at->second = filter.define(*truth_);
    }
    return at->second;
  }
  const reference::Matrix<Quad>& Of(const reference::Filter<Quad>& filter) {
    auto [at, is_new] = quad_matrices_.try_emplace(&filter);
    if (is_new) at->second = filter.define(QuadTruth());
    return at->second;
  }
  reference::Truth<Quad>& QuadTruth() {
    if (!quad_truth_) quad_truth_.emplace(quad_energy_, x_, p_);
    return *quad_truth_;
  }
  // How far the input's own digits leave a definition open.
  double Open(const reference::Filter<Quad>& filter) {
    return Around().Change(filter, QuadTruth());
  }
  Neighbours& Around() {
    if (!neighbours_) neighbours_.emplace(row_, quad_energy_, x_, p_);
    return *neighbours_;
  }

 private:
  const EnergyRow& row_;
  const reference::Energy<double>& energy_;
  const reference::Energy<Quad>& quad_energy_;
  const double *x_, *p_;
  std::optional<Neighbours> neighbours_;
  std::optional<reference::Truth<double>> truth_;  // most configurations ask for neither
  std::optional<reference::Truth<Quad>> quad_truth_;
  std::map<const void*, reference::Matrix<double>> matrices_;
  std::map<const void*, reference::Matrix<Quad>> quad_matrices_;
};

Examiner::Examiner(const EnergyRow& energy, std::span<const KernelRow* const> rows)
    : energy_(&energy),
      rows_(rows.begin(), rows.end()),
      exact_(FindKernel(energy.name + "/none/f64")),
      nearest_(NearestOf(energy, rows)),
      reference_(reference::FindEnergy<double>(energy.name)),
      quad_reference_(reference::FindEnergy<Quad>(energy.name)),
      exact_filter_(reference::FindFilter<Quad>("none")),
      figures_(rows.size()) {
  if (!exact_ || !nearest_) {
    throw std::runtime_error(energy.name + " lacks the row none/f64 or one of the nearest matrix");
  }
  if (!reference_ || !quad_reference_) {
    throw std::runtime_error(energy.name + " has no definition in reference/energies");
  }
  for (const KernelRow* row : rows_) {
    filters_.push_back(reference::FindFilter<double>(row->filter));
    quad_filters_.push_back(reference::FindFilter<Quad>(row->filter));
    if (!filters_.back() || !quad_filters_.back()) {
      throw std::runtime_error(std::string(row->filter) +
                               " has no definition in reference/filters");
    }
  }
}

double Examiner::Bound() const {
  return kRatioBound * energy_->dofs * kUnit / configuration_.conditioning;
}

double Examiner::Bound(const double* x, const double* p) const {
  return kRatioBound * energy_->dofs * kUnit / reference_->conditioning(x, p);
}

void Examiner::Examine(const double* x, const double* p, Depth depth) {
  const auto run = [&](const KernelRow& row) {
    std::vector<double> out(static_cast<std::size_t>(row.outputs));
    RunOne(row, x, p, out.data());
    return out;
  };
  std::vector<std::vector<double>> results;
  for (const KernelRow* row : rows_) results.push_back(run(*row));
  const std::vector<Packed> outputs(results.begin(), results.end());
  Examine(x, p, run(*exact_), run(*nearest_), outputs, depth);
}

void Examiner::Examine(const double* x, const double* p, Packed h, Packed nearest,
                       std::span<const Packed> outputs, Depth depth) {
  const auto measure = [&](Packed f) {
    return Measures{FrobeniusNorm(f), FrobeniusDistance(f, nearest), FrobeniusDistance(f, h),
                    IsPsd(f)};
  };
  std::vector<RowOutput> measured;
  for (std::size_t r = 0; r < outputs.size(); ++r) {
    std::size_t twin = 0;
    while (twin < r &&
           (rows_[twin]->filter != rows_[r]->filter ||
            std::memcmp(outputs[twin].data(), outputs[r].data(), outputs[r].size_bytes()) != 0)) {
      ++twin;
    }
    measured.push_back({outputs[r], measure(outputs[r]), twin});
  }
  Examine(x, p, {h, nearest, measure(h), FrobeniusNorm(nearest)}, measured, depth);
}

void Examiner::Examine(const double* x, const double* p, const ExactOutput& exact,
                       std::span<const RowOutput> outputs, Depth depth) {
  double classification[3];
  energy_->classify(x, p, classification, 1);
  configuration_ = {};
  configuration_.active = classification[0] == 1;
  configuration_.in_domain = classification[1] == 1;
  std::ranges::fill(figures_, RowFigures{});
  if (!configuration_.in_domain) {
    for (RowFigures& figures : figures_) figures.verdict = Verdict::kOutOfDomain;
    return;
  }
  if (!configuration_.active) return;

  configuration_.indefinite = !exact.of_h.psd;
  configuration_.conditioning = reference_->conditioning(x, p);
  Definitions definitions(*energy_, *reference_, *quad_reference_, x, p);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    // Lanes give the same bits as the scalar row before them, as a rule: no need to look twice.
    if (outputs[r].twin < r) {
      figures_[r] = figures_[outputs[r].twin];
    } else if (outputs[r].asked) {
      ExamineRow(r, x, p, exact, outputs[r], depth, definitions);
    }
  }
  if (depth.truth) ExamineEnergy(x, p, definitions);
}

void Examiner::ExamineRow(std::size_t r, const double* x, const double* p, const ExactOutput& exact,
                          const RowOutput& output, Depth depth, Definitions& definitions) {
  const KernelRow& row = *rows_[r];
  RowFigures& figures = figures_[r];
  const auto breaks = [&](Property property) {
    if (row.Promises(property)) figures.broken.push_back(property);
  };
  const auto [norm, to_nearest, to_exact, psd] = output.measures;
  // The norm of finite entries may overflow.
  if (!std::isfinite(norm) && !AllFinite(output.f)) {
    figures.verdict = Verdict::kNonFinite;
    breaks(Property::kFinite);
    return;
  }
  const double h_norm = exact.of_h.norm;
  figures.distance = to_nearest == 0 ? 0 : to_nearest / exact.nearest_norm;
  figures.excess = Excess(to_exact, exact.of_h.to_nearest);

  if (norm > kGrowth * h_norm) figures.verdict = Verdict::kDegraded;
  if (depth.definition) {
    figures.defined = true;
    const double bound = kDegraded / configuration_.conditioning;
    double error = RelativeError(output.f, definitions.Of(*filters_[r]));
    // Written so that a NaN is doubted too.
    const bool ill_conditioned = !(kUnit * h_norm <= kIllConditioned * exact.nearest_norm);
    if (depth.truth || ill_conditioned || !(error <= kDoubt * bound)) {
      ExamineTruth(r, output.f, definitions);
      error = *figures.rounding * energy_->dofs * kUnit;
      // What is open only for a row that promises accuracy: it takes long.
      const bool accurate = *figures.conditioned_rounding <= kRatioBound;
      const bool held = row.Promises(Property::kAccurate) && (!accurate || !(error <= bound));
      if (!held || !IsOpen(r, output.f, definitions)) {
        if (!accurate) breaks(Property::kAccurate);
        if (!(error <= bound)) figures.verdict = Verdict::kDegraded;
      }
    } else if (!(error <= bound)) {
      figures.verdict = Verdict::kDegraded;
    }
  }
  if (!psd) {
    figures.verdict = Verdict::kNonPsd;
    breaks(Property::kPsd);
  }
  if (norm == 0 && h_norm != 0) figures.verdict = Verdict::kSilentZero;
  if (depth.spectrum) {
    ExamineSpectrum(r, x, p, exact, output);
    const double bound = Bound() * (h_norm + norm);
    const double shortfall = *figures.majorises * h_norm, spread = *figures.relabelling * norm;
    if (row.Promises(Property::kMajorises) && shortfall > bound &&
        shortfall >
            bound + definitions.Open(*exact_filter_) + definitions.Open(*quad_filters_[r])) {
      breaks(Property::kMajorises);
    }
    if (row.Promises(Property::kRelabelling) && spread > 2 * bound &&
        spread > bound + Bound(relabelled_.data(), p) * (h_norm + norm) +
                     definitions.Open(*quad_filters_[r]) + OpenElsewhere(*quad_filters_[r], p)) {
      breaks(Property::kRelabelling);
    }
  }
}

double Examiner::OpenElsewhere(const reference::Filter<Quad>& filter, const double* p) const {
  reference::Truth<Quad> truth(*quad_reference_, relabelled_.data(), p);
  return Neighbours(*energy_, *quad_reference_, relabelled_.data(), p).Change(filter, truth);
}

bool Examiner::IsOpen(std::size_t r, Packed f, Definitions& definitions) const {
  const reference::Filter<Quad>& filter = *quad_filters_[r];
  const reference::Matrix<Quad>& definition = definitions.Of(filter);
  return DistanceTo(f, definition) <=
         kRatioBound * energy_->dofs * kUnit * NormOf(definition) + definitions.Open(filter);
}

void Examiner::ExamineTruth(std::size_t r, Packed f, Definitions& definitions) {
  RowFigures& figures = figures_[r];
  const reference::Matrix<Quad>& definition = definitions.Of(*quad_filters_[r]);
  figures.rounding = RelativeError(f, definition) / (energy_->dofs * kUnit);
  figures.conditioned_rounding = *figures.rounding * configuration_.conditioning;
  figures.flip = PositiveCount(f) != PositiveCount(ToPacked(definition));
  // The double P carries an error of u |H|; the true one replaces it here.
  const reference::Matrix<Quad>& exact = definitions.QuadTruth().Hessian();
  const reference::Matrix<Quad>& nearest = definitions.QuadTruth().Nearest();
  figures.distance = RelativeError(f, nearest);
  figures.excess = Excess(DistanceTo(f, exact), NormOf(exact - nearest));
}

void Examiner::ExamineSpectrum(std::size_t r, const double* x, const double* p,
                               const ExactOutput& exact, const RowOutput& output) {
  RowFigures& figures = figures_[r];
  const Packed f = output.f;
  const double norm = output.measures.norm, h_norm = exact.of_h.norm;
  const auto below_zero = [](Packed a) { return std::max(0.0, -Eigenvalues(a).front()); };
  figures.psd_defect = norm == 0 ? 0 : below_zero(f) / (energy_->dofs * kUnit * norm);
  figures.majorises = h_norm == 0 ? 0 : below_zero(Difference(f, exact.h)) / h_norm;

  const int n = energy_->dofs, dimension = energy_->dimension, vertices = n / dimension;
  const auto at = [n](int i, int j) {
    if (i > j) std::swap(i, j);
    return static_cast<std::size_t>(i * n - i * (i - 1) / 2 + j - i);
  };
  double spread = 0;
  std::vector<double> relabelled_x(static_cast<std::size_t>(n)), relabelled(f.size());
  std::vector<double> back(f.size());
  for (std::size_t first = 0; first < energy_->relabellings.size();
       first += static_cast<std::size_t>(vertices)) {
    const auto old_coordinate = [&](int i) {
      return energy_->relabellings[first + static_cast<std::size_t>(i / dimension)] * dimension +
             i % dimension;
    };
    for (int i = 0; i < n; ++i) {
      relabelled_x[static_cast<std::size_t>(i)] = x[old_coordinate(i)];
    }
    RunOne(*rows_[r], relabelled_x.data(), p, relabelled.data());
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) {
        back[at(old_coordinate(i), old_coordinate(j))] = relabelled[at(i, j)];
      }
    }
    if (const double distance = FrobeniusDistance(back, f); !(distance <= spread)) {
      spread = std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
      relabelled_ = relabelled_x;
    }
  }
  figures.relabelling = spread == 0 ? 0 : spread / norm;
}

void Examiner::ExamineEnergy(const double* x, const double* p, Definitions& definitions) {
  const auto n = static_cast<std::size_t>(energy_->dofs);
  double value;
  std::vector<double> gradient(n);
  energy_->value(x, p, &value, 1);
  energy_->gradient(x, p, gradient.data(), 1);

  // Errors in units of what a perturbation of x by one rounding does.
  reference::Truth<Quad>& truth = definitions.QuadTruth();
  std::vector<double> exact_gradient, error;
  for (std::size_t i = 0; i < n; ++i) {
    const Quad exact = truth.Gradient()[static_cast<int>(i)];
    exact_gradient.push_back(static_cast<double>(exact));
    error.push_back(static_cast<double>(gradient[i] - exact));
  }
  const double x_norm = Norm({x, n}), g_norm = Norm(exact_gradient);
  const double value_error = std::abs(static_cast<double>(Quad(value) - truth.Value()));
  const auto ratio = [&](double distance, double scale) {
    return distance == 0 ? 0
                         : distance / scale * configuration_.conditioning / (energy_->dofs * kUnit);
  };
  configuration_.value_rounding =
      ratio(value_error, std::abs(static_cast<double>(truth.Value())) + g_norm * x_norm);
  configuration_.gradient_rounding = ratio(Norm(error), g_norm + NormOf(truth.Hessian()) * x_norm);
  const double worst = std::max(*configuration_.value_rounding, *configuration_.gradient_rounding);
  const auto consistent = [&] {
    const double share = energy_->dofs * kUnit * kRatioBound;
    return value_error <= share * std::abs(static_cast<double>(truth.Value())) +
                              definitions.Around().ValueChange(truth) &&
           Norm(error) <= share * g_norm + definitions.Around().GradientChange(truth);
  };
  if (!(worst * energy_->dofs * kUnit <= kDegraded) && !consistent()) {
    for (RowFigures& figures : figures_) figures.verdict = Verdict::kInconsistent;
  }
}

}  // namespace definite
