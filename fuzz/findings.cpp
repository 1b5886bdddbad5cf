#include "fuzz/findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/sampling/recorded.hpp"

namespace definite::fuzz {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kConsistent = "consistent";
constexpr const char* kCrash = "crash";

Example ExampleOf(const EnergyRow& energy, const Distribution& distribution, std::uint64_t seed,
                  std::uint64_t index) {
  Batch batch(energy);
  batch.Draw(distribution, seed, index, kTile);
  return {{batch.X(0), batch.X(0) + energy.dofs},
          {batch.P(0), batch.P(0) + energy.parameters.size()}};
}

// With that many bits after the point.
double Rounded(double value, int bits) {
  return std::ldexp(std::nearbyint(std::ldexp(value, bits)), -bits);
}

// Changes genes as long as `breaks` holds.
template <class Breaks>
void Simplify(Genes& genes, const Breaks& breaks) {
  const auto accept = [&](const Genes& candidate) {
    if (!breaks(candidate)) return false;
    genes = candidate;
    return true;
  };
  for (const Genes::Pose pose : {Genes::kAxes, Genes::kDyadic}) {
    if (pose >= genes.pose) break;
    Genes candidate = genes;
    candidate.pose = pose;
    if (accept(candidate)) break;
  }
  if (genes.negative) {
    Genes candidate = genes;
    candidate.negative = false;
    accept(candidate);
  }
  for (std::size_t i = 0; i < genes.u.size(); ++i) {
    for (const int bits : {1, 2, 4, 8, 16}) {
      Genes candidate = genes;
      candidate.u[i] = std::clamp(Rounded(genes.u[i], bits), 0x1p-16, 1 - 0x1p-16);
      if (candidate.u[i] == genes.u[i] || accept(candidate)) break;
    }
  }
  for (int exponent = 0; exponent > -54; --exponent) {
    Genes candidate = genes;
    candidate.delta = std::ldexp(1.0, exponent);
    if (candidate.delta <= genes.delta || accept(candidate)) break;
  }
}

// The same with the numbers themselves.
template <class Breaks>
void Simplify(Example& example, const Breaks& breaks) {
  for (double& value : example.x) {
    const double old = value;
    for (const int bits : {0, 1, 2, 4, 8, 12, 16, 24, 32, 40}) {
      value = Rounded(old, bits);
      if (value == old || breaks(example)) break;
      value = old;
    }
  }
}

// Exhibits have rows that are in no table.
const KernelRow* RowNamed(const Plan& plan, const Json& name) {
  const auto row =
      std::ranges::find(plan.rows, name.get_ref<const std::string&>(), &KernelRow::name);
  return row == plan.rows.end() ? nullptr : *row;
}

// The first configuration of a cell where the energy's value or gradient is not right.
std::uint64_t FirstInconsistent(const Plan& plan, const Cell& cell, const KernelRow& row) {
  for (std::uint64_t index = 0; index < plan.each; ++index) {
    const Example example =
        ExampleOf(*cell.energy, *FindFamily(cell.Distribution()), cell.seed, index);
    if (Breaks(row, kConsistent, example)) return index;
  }
  throw std::logic_error(cell.Name() + ": counted as inconsistent, and none is");
}

}  // namespace

Example ExampleOf(const EnergyRow& energy, const Family& family, const Genes& genes) {
  Distribution one;
  one.draw = [&](const DrawTarget& target, std::uint64_t, std::uint64_t, double* x, double* p) {
    Make(family, genes, target, x, p);
  };
  return ExampleOf(energy, one, 0, 0);
}

std::vector<Finding> FindingsOf(const Plan& plan, const std::vector<Json>& cells) {
  std::vector<Finding> findings;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known;
  std::map<std::size_t, std::string> last_cell;  // of a finding
  const auto add = [&](const Json& cell, const std::string& what, const Json& kernels,
                       std::uint64_t index, const std::string& how) {
    const auto key = std::tuple(cell.at("energy").get<std::string>(),
                                cell.at("family").get<std::string>(), what);
    const auto [at, is_new] = known.try_emplace(key, findings.size());
    if (is_new) {
      const auto family = std::ranges::find(plan.families, std::get<1>(key),
                                            [](const Family* f) { return f->name; });
      const auto energy = std::ranges::find(AllEnergies(), std::get<0>(key), &EnergyRow::name);
      findings.push_back(
          {{cell.at("seed"), &*energy, *family, cell.at("decade")}, what, {}, index, 0, how});
    }
    Finding& finding = findings[at->second];
    if (std::string name = NameOf(cell); last_cell[at->second] != name) {
      ++finding.cells;
      last_cell[at->second] = std::move(name);
    }
    for (const Json& name : kernels) {
      if (name.is_null()) continue;
      const KernelRow* row = RowNamed(plan, name);
      if (std::ranges::find(finding.rows, row) == finding.rows.end()) finding.rows.push_back(row);
    }
  };
  // Decades are in order, from the least degenerate on.
  for (const Json& cell : cells) {
    for (const Json& row : cell.at("rows")) {
      for (const Json& broken : row.at("broken_promises")) {
        add(cell, broken.at("property"), row.at("kernels"), broken.at("index"), "");
      }
    }
    for (const Json& row : cell.at("rows")) {
      if (!row.at("verdicts").contains("inconsistent")) continue;
      add(cell, kConsistent, row.at("kernels"), 0, "");
      break;  // it is the energy, not the filter
    }
    for (const Json& crash : cell.at("crashes")) {
      add(cell, kCrash, Json::array({crash.at("kernel")}), crash.at("index"), crash.at("how"));
    }
  }
  for (Finding& finding : findings) {
    if (finding.what != kConsistent) continue;
    finding.index = FirstInconsistent(plan, finding.cell, *finding.rows.front());
  }
  return findings;
}

std::string ReplayCommand(const Finding& finding) {
  if (finding.rows.empty()) return "";
  SweepPlan sweep;
  sweep.distribution = FindFamily(finding.cell.Distribution());
  sweep.seed = finding.cell.seed;
  return definite::ReplayCommand(sweep, *finding.rows.front(), finding.index);
}

Example Found(const Finding& finding) {
  const Cell& cell = finding.cell;
  return ExampleOf(*cell.energy, *FindFamily(cell.Distribution()), cell.seed, finding.index);
}

bool Breaks(const KernelRow& row, const std::string& what, const Example& example) {
  const KernelRow* const rows[] = {&row};
  Examiner examiner(*row.energy, rows);
  examiner.Examine(example.x.data(), example.p.data(), Depth::kTruth);
  const RowFigures& figures = examiner.Row(0);
  if (what == kConsistent) return figures.verdict == Verdict::kInconsistent;
  return std::ranges::any_of(figures.broken,
                             [&](Property property) { return PropertyName(property) == what; });
}

Example Shrunk(const Finding& finding) {
  const Cell& cell = finding.cell;
  const KernelRow& row = *finding.rows.front();
  const auto breaks = [&](const Example& example) { return Breaks(row, finding.what, example); };
  Example example = Found(finding);
  if (!breaks(example)) return example;  // broken only beside the others of its tile
  Genes genes = GenesAt(*cell.family, cell.decade, cell.seed, finding.index);
  Simplify(genes, [&](const Genes& candidate) {
    return breaks(ExampleOf(*cell.energy, *cell.family, candidate));
  });
  example = ExampleOf(*cell.energy, *cell.family, genes);
  Simplify(example, breaks);
  return example;
}

std::string FuzzCommand(const Finding& finding) {
  return fmt::format("definite fuzz --kernels {} --families {} --seed {}",
                     finding.rows.front()->name, finding.cell.family->name, finding.cell.seed);
}

std::string CorpusText(const std::string& command, const std::string& what, const EnergyRow& energy,
                       const Example& example) {
  std::string settings = fmt::format("stencil={}", energy.stencil);
  for (std::size_t j = 0; j < energy.parameters.size(); ++j) {
    settings += fmt::format(" {}={}", energy.parameters[j].name, HexFloat(example.p[j]));
  }
  std::vector<std::string> numbers;
  for (const double x : example.x) numbers.push_back(HexFloat(x));
  return fmt::format("# found by: {}\n# {} was not {}\n# {}\n{}\n{}\n", command, energy.name, what,
                     settings, fmt::join(CoordinateNames(energy.dofs, energy.dimension), ","),
                     fmt::join(numbers, ","));
}

}  // namespace definite::fuzz
