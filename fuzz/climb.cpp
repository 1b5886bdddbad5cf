#include "fuzz/climb.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "benchmarks/harness/blocks.hpp"
#include "fuzz/report.hpp"

namespace definite::fuzz {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Whether a row that promises accuracy is off by more, and breaks no promise: the digits of the
// input leave it open, and no figure says anything of the filter.
bool IsOpen(const KernelRow& row, const RowFigures& figures) {
  return row.Promises(Property::kAccurate) &&
         figures.conditioned_rounding.value_or(0) > kRatioBound &&
         std::ranges::find(figures.broken, Property::kAccurate) == figures.broken.end();
}

constexpr std::array kSlopes = {
    Slope{"distance", "|F - P| / |P|, P the nearest PSD matrix", Depth::kCheap,
          [](const RowFigures& f) { return f.distance.value_or(kNone); }},
    Slope{"excess", "|F - H| / |P - H|", Depth::kCheap,
          [](const RowFigures& f) { return f.excess.value_or(kNone); }},
    Slope{"psd_defect", "-lambda_min(F) / (n u |F|)", Depth::kSpectral,
          [](const RowFigures& f) { return f.psd_defect.value_or(kNone); }},
    Slope{"relabelling", "|F - F of the relabelled pair| / |F|", Depth::kSpectral,
          [](const RowFigures& f) { return f.relabelling.value_or(kNone); }},
    Slope{"rounding", "|F - F128| / (n u |F128|), conditioned", Depth::kTruth,
          [](const RowFigures& f) { return f.conditioned_rounding.value_or(kNone); }},
};

// One gene changed, by a little or by a lot.
Genes Step(Genes genes, Draws& draws) {
  const double size = std::pow(10.0, -4 * draws.OpenUniform());
  const double by = size * (2 * draws.OpenUniform() - 1);
  const auto which = static_cast<std::size_t>(16 * draws.Uniform());
  if (which < genes.u.size()) {
    genes.u[which] = std::clamp(genes.u[which] + by, 0x1p-40, 1 - 0x1p-40);
  } else if (which == genes.u.size()) {
    genes.negative = !genes.negative;
  } else if (which == genes.u.size() + 1) {
    genes.pose = static_cast<Genes::Pose>(static_cast<int>(3 * draws.Uniform()));
  } else {
    genes.delta = std::clamp(genes.PositiveDelta() * std::pow(10.0, 8 * by), 1e-16, 1.0);
  }
  return genes;
}

}  // namespace

std::span<const Slope> AllSlopes() { return kSlopes; }

Summit Climb(const KernelRow& row, const Family& family, const Slope& slope, std::uint64_t seed,
             std::uint64_t evaluations) {
  const KernelRow* const rows[] = {&row};
  Examiner examiner(*row.energy, rows);
  const auto height = [&](const Example& example, Depth depth) {
    examiner.Examine(example.x.data(), example.p.data(), depth);
    const RowFigures& figures = examiner.Row(0);
    if (!examiner.Configuration().active || figures.verdict == Verdict::kOutOfDomain) return -1.0;
    // Beside eps a truth that is 0 makes figures of infinity.
    const double value = slope.of(figures);
    return std::isfinite(value) && !IsOpen(row, figures) ? value : -1.0;
  };
  Draws draws(StreamId("climb"), seed, StreamId(row.name) ^ StreamId(family.name));
  Summit summit{&row, &family, {}, -1};
  for (std::uint64_t i = 0; i < evaluations; ++i) {
    const bool steps = 4 * i >= evaluations && summit.value >= 0;
    const Genes genes = steps ? Step(summit.genes, draws) : DrawGenes(draws);
    const Example example = ExampleOf(*row.energy, family, genes);
    // In double the nearest matrix may itself be far off: what seems higher is looked at again.
    double value = height(example, slope.depth);
    if (value >= summit.value && value >= 0) value = height(example, Depth::kTruth);
    if (value < summit.value || value < 0) continue;
    summit.genes = genes;
    summit.value = value;
  }
  return summit;
}

std::vector<Summit> ClimbAll(std::span<const KernelRow* const> rows,
                             std::span<const Family* const> families, const Slope& slope,
                             std::uint64_t seed, std::uint64_t evaluations, int threads,
                             const std::function<void()>& done) {
  std::vector<Summit> highest(rows.size());
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t r = 0; r < rows.size(); ++r) {
    highest[r] = {rows[r], nullptr, {}, -1};
    for (const Family* family : families) {
      if (Interrupted()) break;
      if (family->Has(rows[r]->energy->stencil)) {
        const Summit summit = Climb(*rows[r], *family, slope, seed, evaluations);
        if (summit.value > highest[r].value) highest[r] = summit;
      }
#pragma omp critical
      done();
    }
  }
  std::erase_if(highest, [](const Summit& summit) { return summit.value < 0; });
  std::ranges::stable_sort(highest, std::ranges::greater(), &Summit::value);
  return highest;
}

std::string ToTable(const Slope& slope, const std::vector<Summit>& summits) {
  std::string table =
      fmt::format("largest known {}, {}\n\n{:>9}  {:<62} {:<17} {:>7}\n", slope.name, slope.meaning,
                  slope.name, "row", "in family", "delta");
  for (const Summit& summit : summits) {
    table += fmt::format("{:>9.2g}  {:<62} {:<17} {:>7.0e}\n", summit.value, summit.row->name,
                         summit.family->name, summit.genes.delta);
  }
  return table;
}

nlohmann::ordered_json ToJson(const Slope& slope, std::uint64_t evaluations,
                              const std::vector<Summit>& summits) {
  nlohmann::ordered_json json = {{"figure", slope.name}, {"evaluations", evaluations}};
  json["summits"] = nlohmann::ordered_json::array();
  for (const Summit& summit : summits) {
    const Example example = ExampleOf(*summit.row->energy, *summit.family, summit.genes);
    json["summits"].push_back({{"kernel", summit.row->name},
                               {"family", summit.family->name},
                               {"delta", summit.genes.delta},
                               {"value", summit.value},
                               {"x", HexNumbers(example.x)},
                               {"p", HexNumbers(example.p)}});
  }
  return json;
}

}  // namespace definite::fuzz
