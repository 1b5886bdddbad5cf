#include "benchmarks/verify/case.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "benchmarks/harness/sampling/batch.hpp"

namespace definite::verify {

namespace {

std::vector<Quad> InQuad(const Numbers& v) { return {v.begin(), v.end()}; }

}  // namespace

const KernelRow* Subject::Row(std::string_view filter) const {
  const auto at = std::ranges::find_if(rows, [&](const KernelRow* row) {
    return row->filter == filter && row->scalar == "f64" && row->output == "packed";
  });
  return at != rows.end() ? *at : FindKernel(energy->name + "/" + std::string(filter) + "/f64");
}

Subject SubjectOf(const EnergyRow& energy, std::vector<const KernelRow*> rows) {
  const Subject subject = {&energy, std::move(rows), reference::FindEnergy<Quad>(energy.name)};
  if (!subject.reference) {
    throw std::runtime_error(energy.name + " has no definition in reference/energies");
  }
  for (const KernelRow* row : subject.rows) {
    if (reference::FindFilter<Quad>(row->filter)) continue;
    throw std::runtime_error(std::string(row->filter) + " has no definition in reference/filters");
  }
  return subject;
}

Case::Case(const Subject& subject, const double* x, const double* p)
    : subject_(subject),
      x_(x, x + subject.energy->dofs),
      p_(p, p + subject.energy->parameters.size()),
      truth_(*subject.reference, x, p),
      conditioning_(subject.reference->conditioning(InQuad(x_).data(), InQuad(p_).data())) {}

bool HasPart(std::string_view name, std::string_view part) {
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('/'), name.size());
    if (name.substr(0, end) == part) return true;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return false;
}

Numbers Case::Classified(const Numbers& x) const {
  Numbers where(3);
  Energy().classify(x.data(), p_.data(), where.data(), 1);
  return where;
}

bool Case::SameAround(const Numbers& d, double s) const {
  const Numbers here = Classified(x_);
  for (const double step : {s, -s}) {
    Numbers x = x_;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * d[i];
    if (Classified(x) != here) return false;
  }
  return true;
}

double Case::ValueAt(const Numbers& x) const {
  double value;
  Energy().value(x.data(), p_.data(), &value, 1);
  return value;
}

Numbers Case::GradientAt(const Numbers& x) const {
  Numbers gradient(x.size());
  Energy().gradient(x.data(), p_.data(), gradient.data(), 1);
  return gradient;
}

const Numbers& Case::Output(const KernelRow& row) {
  const auto [at, is_new] = outputs_.try_emplace(&row);
  if (is_new) {
    at->second.resize(static_cast<std::size_t>(row.outputs));
    RunOne(row, x_.data(), p_.data(), at->second.data());
  }
  return at->second;
}

Matrix Case::Hessian() { return Unpacked(Output(*subject_.Row("none"))); }

const Matrix& Case::Definition(std::string_view filter) {
  const auto [at, is_new] = definitions_.try_emplace(filter);
  if (is_new) at->second = reference::FindFilter<Quad>(filter)->define(truth_);
  return at->second;
}

double Case::Length() const {
  if (!subject_.reference->length) return std::numeric_limits<double>::infinity();
  return static_cast<double>(subject_.reference->length(InQuad(x_).data(), InQuad(p_).data()));
}

double Case::Ratio(const Quad& error, const Quad& scale, int n) const {
  if (error == 0) return 0;
  const double unit = kRatioBound * (n ? n : Energy().dofs) * kUnit;
  return static_cast<double>(abs(error) / scale) * conditioning_ / unit;
}

Matrix ToVector(const Numbers& v) {
  Matrix m(static_cast<int>(v.size()), 1);
  std::ranges::copy(v, m.entries.begin());
  return m;
}

Matrix Unpacked(Packed a) {
  const int n = PackedRows(a);
  Matrix m(n, n);
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) m(i, j) = m(j, i) = a[k++];
  }
  return m;
}

Numbers ToDouble(const Matrix& v) {
  Numbers numbers;
  for (const Quad& entry : v.entries) numbers.push_back(static_cast<double>(entry));
  return numbers;
}

Quad Dot(const Matrix& a, const Matrix& b) {
  Quad sum = 0;
  for (std::size_t i = 0; i < a.entries.size(); ++i) sum += a.entries[i] * b.entries[i];
  return sum;
}

}  // namespace definite::verify
