#include "fuzz/zoo.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "benchmarks/harness/sampling/batch.hpp"

namespace definite::fuzz {

namespace {

constexpr const char* kFace = "collision/vertex_face/signed/quadratic";
constexpr const char* kMollified = "collision/edge_edge/mollified/quadratic";

using Matrix = Eigen::Matrix<double, 12, 12>;
using Point3 = Eigen::Vector3d;

Point3 VertexOf(const double* x, int i) { return {x[3 * i], x[3 * i + 1], x[3 * i + 2]}; }

const KernelRow& RowOf(const std::string& name) {
  const KernelRow* row = FindKernel(name);
  if (!row) throw std::runtime_error(name + ": the zoo needs this row");
  return *row;
}

Matrix HessianOf(const std::string& energy, const double* x, const double* p) {
  std::vector<double> packed(78);
  RunOne(RowOf(energy + "/none/f64"), x, p, packed.data());
  Matrix h;
  std::size_t k = 0;
  for (int i = 0; i < 12; ++i) {
    for (int j = i; j < 12; ++j) h(i, j) = h(j, i) = packed[k++];
  }
  return h;
}

template <class Map>
Matrix MapEigenvalues(const Matrix& h, Map map) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(h);
  return solver.eigenvectors() * solver.eigenvalues().unaryExpr(map).asDiagonal() *
         solver.eigenvectors().transpose();
}

// An exhibit's row: what `kFilter` makes of each configuration.
template <auto kFilter>
void RunExhibit(const double* x, const double* p, double* out, long count, int parameters) {
  for (long i = 0; i < count; ++i) {
    const Matrix f = kFilter(x + 12 * i, p + parameters * i);
    for (int row = 0; row < 12; ++row) {
      for (int column = row; column < 12; ++column) *out++ = f(row, column);
    }
  }
}

// Eigenvalues below a least one are turned positive; somebody set that to -1.
Matrix SwitchedOff(const double* x, const double* p) {
  return MapEigenvalues(HessianOf(kFace, x, p), [](double v) { return v < -1 ? -v : v; });
}

// Turns whatever is below a small positive number, the positive ones too.
Matrix MirrorsSmall(const double* x, const double* p) {
  return MapEigenvalues(HessianOf(kFace, x, p), [](double v) { return v < 1e-3 ? -v : v; });
}

// Takes the edges for parallel, and then leaves the block as it is.
Matrix LeavesParallel(const double* x, const double* p) {
  const Matrix h = HessianOf(kMollified, x, p);
  const double c =
      (VertexOf(x, 1) - VertexOf(x, 0)).cross(VertexOf(x, 3) - VertexOf(x, 2)).squaredNorm();
  if (c < 1e-10) return h;
  return MapEigenvalues(h, [](double v) { return std::max(v, 0.0); });
}

// No face of less than 1e-10 square units.
Matrix DropsSmallFaces(const double* x, const double* p) {
  const Point3 normal = (VertexOf(x, 1) - VertexOf(x, 2)).cross(VertexOf(x, 3) - VertexOf(x, 2));
  if (normal.squaredNorm() < 1e-20) return Matrix::Zero();
  return MapEigenvalues(HessianOf(kFace, x, p), [](double v) { return std::max(v, 0.0); });
}

double LengthOf(const double* x) {
  return (VertexOf(x, 1) - VertexOf(x, 2))
      .cross(VertexOf(x, 3) - VertexOf(x, 2))
      .dot(VertexOf(x, 0) - VertexOf(x, 2));
}

Matrix AssertsApart(const double* x, const double* p) {
  if (LengthOf(x) == 0) std::abort();
  return MapEigenvalues(HessianOf(kFace, x, p), [](double v) { return std::max(v, 0.0); });
}

Matrix HalvesForEver(const double* x, const double* p) {
  volatile double l = LengthOf(x);
  while (std::abs(l) < 1e-12) l = l / 2;
  return MapEigenvalues(HessianOf(kFace, x, p), [](double v) { return std::max(v, 0.0); });
}

// Adds one that claims to be the filter of another row, if that was built.
void Add(std::vector<Exhibit>& exhibits, std::string_view name, std::string_view mistake,
         std::string_view caught_by, const std::string& claims, decltype(KernelRow::run) run) {
  const KernelRow* like = FindKernel(claims + "/f64");
  if (!like) return;
  KernelRow row = *like;
  row.name = fmt::format("zoo/{}", name);
  row.exempt = {};
  if (run) row.run = run;
  exhibits.push_back({name, mistake, caught_by, row});
}

template <auto kFilter, int kParameters>
void Run(const double* x, const double* p, double* out, long count) {
  RunExhibit<kFilter>(x, p, out, count, kParameters);
}

std::vector<Exhibit> MakeExhibits() {
  const std::string face = kFace, mollified = kMollified;
  std::vector<Exhibit> all;
  Add(all, "as_printed", "the eigensystem as printed: divides by l", "finite",
      face + "/analytic_printed", nullptr);
  Add(all, "switched_off", "absolute, its least eigenvalue set to -1", "psd",
      face + "/absolute_numeric", Run<SwitchedOff, 3>);
  Add(all, "mirrors_small", "turns eigenvalues below 1e-3, those above 0 too", "psd",
      face + "/absolute_numeric", Run<MirrorsSmall, 3>);
  Add(all, "leaves_parallel", "no projection where |e0 x e1|^2 < 1e-10", "psd",
      mollified + "/nearest", Run<LeavesParallel, 4>);
  Add(all, "drops_small_faces", "zero where |e0 x e1|^2 < 1e-20", "scale", face + "/nearest",
      Run<DropsSmallFaces, 3>);
  Add(all, "asserts_apart", "assert(l != 0)", "crash", face + "/nearest", Run<AssertsApart, 3>);
  Add(all, "halves_for_ever", "a loop that waits for |l| to be large", "crash", face + "/nearest",
      Run<HalvesForEver, 3>);
  return all;
}

}  // namespace

std::span<const Exhibit> Exhibits() {
  static const std::vector<Exhibit> exhibits = MakeExhibits();
  return exhibits;
}

std::optional<Finding> Catch(const Exhibit& exhibit) {
  Plan plan;
  plan.rows = {&exhibit.row};
  for (const Family& family : AllFamilies()) plan.families.push_back(&family);
  plan.each = 8;
  plan.samples = {1, 1, 0};
  plan.worst_cases = false;
  RunOptions options;
  options.cell_seconds = 0.2;
  options.case_seconds = 0.2;
  for (const Cell& cell : CellsOf(plan)) {
    std::optional<Finding> found;
    fuzz::Run(plan, {cell}, options, [&](const Cell&, nlohmann::ordered_json json) {
      for (Finding& finding : FindingsOf(plan, {std::move(json)})) {
        if (finding.what == exhibit.caught_by) found = std::move(finding);
      }
    });
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace definite::fuzz
