#include "benchmarks/harness/examine.hpp"

#include <algorithm>
#include <bit>
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

// In long double, where no square leaves the range.
double Norm(std::span<const double> v) {
  long double sum = 0;
  for (long double a : v) sum += a * a;
  return static_cast<double>(std::sqrt(sum));
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

// In float128.
double ConditioningAt(const reference::Energy<Quad>& energy, const double* x, const double* p,
                      const EnergyRow& row) {
  const std::vector<Quad> quad_x(x, x + row.dofs), quad_p(p, p + row.parameters.size());
  return energy.conditioning(quad_x.data(), quad_p.data());
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
  // The double classification may err beside the border, where the truth is undefined.
  bool InDomain() {
    if (!in_domain_) {
      const std::vector<Quad> x(x_, x_ + row_.dofs), p(p_, p_ + row_.parameters.size());
      in_domain_ = quad_energy_.in_domain(x.data(), p.data());
    }
    return *in_domain_;
  }
  // Double takes a wrong region for it beside the border of two.
  double Conditioning() {
    if (!conditioning_) conditioning_ = ConditioningAt(quad_energy_, x_, p_, row_);
    return *conditioning_;
  }
  // Whether the filter's definition is the Hessian itself, to the digits of float128.
  bool Keeps(const reference::Filter<Quad>& filter) {
    const reference::Matrix<Quad>& exact = QuadTruth().Hessian();
    return NormOf(exact - Of(filter)) <= 1e-25 * NormOf(exact);
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
  std::optional<bool> in_domain_;
  std::optional<double> conditioning_;
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
      symmetries_(SymmetriesOf(energy)),
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

double Examiner::Conditioning(const double* x, const double* p) const {
  // Fourth powers of lengths leave the range of doubles where lengths are far from 1.
  double largest = 0;
  for (int i = 0; i < energy_->dofs; ++i) largest = std::max(largest, std::abs(x[i]));
  if (largest > 1e-60 && largest < 1e60) return reference_->conditioning(x, p);
  return ConditioningAt(*quad_reference_, x, p, *energy_);
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
  configuration_.conditioning = Conditioning(x, p);
  Definitions definitions(*energy_, *reference_, *quad_reference_, x, p);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    // Lanes give the same bits as the scalar row before them, as a rule: no need to look twice.
    if (outputs[r].twin < r) {
      figures_[r] = figures_[outputs[r].twin];
    } else if (outputs[r].asked) {
      ExamineRow(r, x, p, exact, outputs[r], depth, definitions);
      if (DiffersFromScalar(r, outputs)) {
        figures_[r].broken.push_back(Property::kLanesEqualScalar);
      }
    }
  }
  if (depth.truth && definitions.InDomain()) ExamineEnergy(x, p, definitions);
}

bool Examiner::DiffersFromScalar(std::size_t r, std::span<const RowOutput> outputs) const {
  const KernelRow& row = *rows_[r];
  if (row.lanes == 1 || !row.Promises(Property::kLanesEqualScalar)) return false;
  const auto scalar = std::ranges::find_if(rows_, [&](const KernelRow* other) {
    return other->filter == row.filter && other->lanes == 1;
  });
  if (scalar == rows_.end()) return false;
  const Packed a = outputs[r].f, b = outputs[static_cast<std::size_t>(scalar - rows_.begin())].f;
  return !std::ranges::equal(a, b, [](double u, double v) {
    return std::bit_cast<std::uint64_t>(u) == std::bit_cast<std::uint64_t>(v) ||
           (std::isnan(u) && std::isnan(v));
  });
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
    if (!definitions.InDomain()) {
      figures.verdict = Verdict::kOutOfDomain;
      return;
    }
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
    double bound = kDegraded / configuration_.conditioning;
    double error = RelativeError(output.f, definitions.Of(*filters_[r]));
    // Written so that a NaN is doubted too.
    const bool ill_conditioned = !(kUnit * h_norm <= kIllConditioned * exact.nearest_norm);
    if (depth.truth || ill_conditioned || !(error <= kDoubt * bound)) {
      if (!definitions.InDomain()) {
        figures = {};
        figures.verdict = Verdict::kOutOfDomain;
        return;
      }
      ExamineTruth(r, output.f, definitions);
      bound = kDegraded / configuration_.conditioning;
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
  // Some Hessians have no positive part.
  if (norm == 0 && h_norm != 0 && !(NormOf(definitions.Of(*quad_filters_[r])) == 0)) {
    figures.verdict = Verdict::kSilentZero;
  }
  if (depth.spectrum) {
    ExamineSpectrum(r, exact, output, definitions);
    ExamineSymmetries(r, x, p, exact, output, definitions);
  }
}

double Examiner::BoundAt(const double* x, const double* p) const {
  return kRatioBound * energy_->dofs * kUnit / ConditioningAt(*quad_reference_, x, p, *energy_);
}

// In float128; other units may leave a domain.
bool Examiner::InDomainAt(std::span<const double> x, std::span<const double> p) const {
  const std::vector<Quad> quad_x(x.begin(), x.end()), quad_p(p.begin(), p.end());
  return quad_reference_->in_domain(quad_x.data(), quad_p.data());
}

double Examiner::OpenAt(const reference::Filter<Quad>& filter, const double* x,
                        const double* p) const {
  reference::Truth<Quad> truth(*quad_reference_, x, p);
  return Neighbours(*energy_, *quad_reference_, x, p).Change(filter, truth);
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
  configuration_.conditioning = definitions.Conditioning();
  figures.rounding = RelativeError(f, definition) / (energy_->dofs * kUnit);
  figures.conditioned_rounding = *figures.rounding * configuration_.conditioning;
  figures.flip = PositiveCount(f) != PositiveCount(ToPacked(definition));
  // The double P carries an error of u |H|; the true one replaces it here.
  const reference::Matrix<Quad>& exact = definitions.QuadTruth().Hessian();
  const reference::Matrix<Quad>& nearest = definitions.QuadTruth().Nearest();
  figures.distance = RelativeError(f, nearest);
  figures.excess = Excess(DistanceTo(f, exact), NormOf(exact - nearest));
}

void Examiner::ExamineSpectrum(std::size_t r, const ExactOutput& exact, const RowOutput& output,
                               Definitions& definitions) {
  const KernelRow& row = *rows_[r];
  RowFigures& figures = figures_[r];
  const Packed f = output.f;
  const double norm = output.measures.norm, h_norm = exact.of_h.norm;
  const auto below_zero = [](Packed a) { return std::max(0.0, -Eigenvalues(a).front()); };
  figures.psd_defect = norm == 0 ? 0 : below_zero(f) / (energy_->dofs * kUnit * norm);
  const double shortfall = below_zero(Difference(f, exact.h));
  figures.majorises = h_norm == 0 ? 0 : shortfall / h_norm;
  // H and F, and each with what the digits of the input leave open.
  const auto exceeds = [&](double error) {
    if (error <= Bound() * (h_norm + norm) || !definitions.InDomain()) return false;
    configuration_.conditioning = definitions.Conditioning();
    const double bound = Bound() * (h_norm + norm);
    return !(error <= bound) && !(error <= bound + definitions.Open(*exact_filter_) +
                                               definitions.Open(*quad_filters_[r]));
  };
  if (row.Promises(Property::kMajorises) && exceeds(shortfall)) {
    figures.broken.push_back(Property::kMajorises);
  }
  // In double a Hessian counts as PSD with negative eigenvalues of its rounding.
  if (row.Promises(Property::kKeepsPsd) && exact.of_h.psd && exceeds(output.measures.to_exact) &&
      definitions.Keeps(*quad_filters_[r])) {
    figures.broken.push_back(Property::kKeepsPsd);
  }
  if (row.Promises(Property::kTranslation) && exceeds(OnTranslations(*energy_, f))) {
    figures.broken.push_back(Property::kTranslation);
  }
}

void Examiner::ExamineSymmetries(std::size_t r, const double* x, const double* p,
                                 const ExactOutput& exact, const RowOutput& output,
                                 Definitions& definitions) {
  const KernelRow& row = *rows_[r];
  RowFigures& figures = figures_[r];
  const double norm = output.measures.norm, h_norm = exact.of_h.norm;
  const reference::Filter<Quad>& filter = *quad_filters_[r];
  double relabelling = 0;
  std::vector<double> new_x, new_p, result(output.f.size());
  for (const Symmetry& symmetry : symmetries_) {
    const bool is_relabelling = symmetry.property == Property::kRelabelling;
    if (!is_relabelling && !row.Promises(symmetry.property)) continue;
    if (!symmetry.Apply(*energy_, x, p, new_x, new_p)) continue;
    RunOne(row, new_x.data(), new_p.data(), result.data());
    double spread = FrobeniusDistance(result, symmetry.Expected(output.f));
    if (std::isnan(spread)) spread = std::numeric_limits<double>::infinity();
    if (is_relabelling) relabelling = std::max(relabelling, spread);
    if (spread <= 2 * Bound() * (h_norm + norm) || !row.Promises(symmetry.property) ||
        !definitions.InDomain() || !InDomainAt(new_x, new_p) ||
        std::ranges::find(figures.broken, symmetry.property) != figures.broken.end()) {
      continue;
    }
    configuration_.conditioning = definitions.Conditioning();
    const double here = Bound() * (h_norm + norm) + definitions.Open(filter);
    // Other numbers may be worse conditioned; turned or scaled, they are as good.
    const double there = is_relabelling ? (h_norm + norm) * BoundAt(new_x.data(), p) +
                                              OpenAt(filter, new_x.data(), p)
                                        : here;
    if (!(spread <= here + there)) figures.broken.push_back(symmetry.property);
  }
  figures.relabelling = relabelling == 0 ? 0 : relabelling / norm;
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
    // What subnormal numbers round.
    const double least = kRatioBound * std::numeric_limits<double>::denorm_min();
    return value_error <= share * std::abs(static_cast<double>(truth.Value())) + least +
                              definitions.Around().ValueChange(truth) &&
           Norm(error) <= share * g_norm + least + definitions.Around().GradientChange(truth);
  };
  if (!(worst * energy_->dofs * kUnit <= kDegraded) && !consistent()) {
    for (RowFigures& figures : figures_) figures.verdict = Verdict::kInconsistent;
  }
}

}  // namespace definite
