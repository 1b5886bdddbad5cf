// definite replay: one configuration whole.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/report.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "tools/command_line.hpp"

namespace definite {

namespace {

struct ReplayOptions {
  std::string kernel, distribution = "active", seed = "42", index;
  std::vector<std::string> overrides;
  bool json = false;
};

struct Replay {
  SweepPlan plan;
  std::uint64_t index;
  const KernelRow* chosen;
  std::vector<const KernelRow*> rows;  // of the same energy
  std::vector<double> x, p;
  std::vector<double> eigenvalues;  // of the exact Hessian, from float128
  std::vector<std::vector<double>> outputs;
};

Replay Load(const ReplayOptions& options) {
  Replay replay;
  replay.chosen = &RowNamed(options.kernel);
  replay.plan.distribution = &DistributionNamed(options.distribution);
  replay.plan.seed = ParseCount("--seed", options.seed, 0);
  replay.index = ParseCount("--index", options.index, 0);
  const EnergyRow& energy = *replay.chosen->energy;
  if (!replay.plan.distribution->supports(energy.stencil)) {
    throw UsageError(fmt::format("--distribution '{}': it cannot draw a {}", options.distribution,
                                 energy.stencil));
  }
  for (const KernelRow& row : AllKernels()) {
    if (row.energy == &energy) replay.rows.push_back(&row);
  }
  replay.plan.overrides = ParseOverrides(options.overrides, {replay.chosen});
  Batch batch(energy, replay.plan.overrides);
  batch.Draw(*replay.plan.distribution, replay.plan.seed, replay.index, kTile);
  replay.x.assign(batch.X(0), batch.X(0) + energy.dofs);
  replay.p.assign(batch.P(0), batch.P(0) + energy.parameters.size());
  const auto* reference = reference::FindEnergy<reference::Quad>(energy.name);
  if (!reference) throw UsageError(energy.name + " has no definition in reference/");
  reference::Truth<reference::Quad> truth(*reference, replay.x.data(), replay.p.data());
  for (const auto& value : truth.HessianSpectrum().values.entries) {
    replay.eigenvalues.push_back(static_cast<double>(value));
  }
  for (const KernelRow* row : replay.rows) {
    replay.outputs.emplace_back(static_cast<std::size_t>(row->outputs));
    RunOne(*row, replay.x.data(), replay.p.data(), replay.outputs.back().data());
  }
  return replay;
}

std::string Show(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

// With a common power of ten, so that twelve columns fit.
void PrintMatrix(const KernelRow& row, const std::vector<double>& packed) {
  double largest = 0;
  for (double a : packed) {
    if (std::isfinite(a)) largest = std::max(largest, std::abs(a));
  }
  const int exponent = largest > 0 ? static_cast<int>(std::floor(std::log10(largest))) : 0;
  const double unit = std::pow(10.0, exponent);
  fmt::print("\n{}, in units of 1e{}\n", row.name, exponent);
  const int n = row.energy->dofs;
  std::size_t k = 0;
  for (int i = 0; i < n; ++i) {
    fmt::print("{:{}}", "", 8 * i);
    for (int j = i; j < n; ++j) fmt::print("{:8.3f}", packed[k++] / unit);
    fmt::print("\n");
  }
}

void Print(const Replay& replay, const Examiner& examiner) {
  const EnergyRow& energy = *replay.chosen->energy;
  const ConfigurationFigures& c = examiner.Configuration();
  fmt::print("{}\n{}{}, seed {}, index {}\n\n", energy.name, replay.plan.distribution->name,
             Describe(replay.plan, energy), replay.plan.seed, replay.index);
  for (int i = 0; i < energy.dofs; ++i) {
    const double x = replay.x[static_cast<std::size_t>(i)];
    fmt::print("x{}[{}] {:>24.17g}  {}\n", i / energy.dimension, i % energy.dimension, x,
               HexFloat(x));
  }
  for (std::size_t i = 0; i < replay.p.size(); ++i) {
    fmt::print("{:<5} {:>24.17g}  {}\n", energy.parameters[i].name, replay.p[i],
               HexFloat(replay.p[i]));
  }
  fmt::print("\n{}; {}; conditioning {:.3g}\n",
             c.in_domain ? "in the domain" : "outside the domain", c.active ? "active" : "inactive",
             c.conditioning);
  fmt::print("eigenvalues of the exact Hessian (float128):\n");
  for (double value : replay.eigenvalues) fmt::print("  {:.17g}\n", value);
  fmt::print("\n{:<24}{:>10}{:>9}{:>10}{:>10}{:>10}{:>10}  {}\n", "row", "distance", "excess",
             "rounding", "defect", "majorises", "relab.", "verdict");
  for (std::size_t r = 0; r < replay.rows.size(); ++r) {
    const RowFigures& f = examiner.Row(r);
    fmt::print("{:<24}{:>10}{:>9}{:>10}{:>10}{:>10}{:>10}  {}\n",
               fmt::format("{}/{}", replay.rows[r]->filter, replay.rows[r]->scalar),
               Show(f.distance), Show(f.excess), Show(f.conditioned_rounding), Show(f.psd_defect),
               Show(f.majorises), Show(f.relabelling),
               kVerdictNames[static_cast<std::size_t>(f.verdict)]);
  }
  for (std::size_t r = 0; r < replay.rows.size(); ++r) {
    // Lanes that agree with the scalar row bit for bit are not shown again.
    std::size_t same = 0;
    while (replay.rows[same]->filter != replay.rows[r]->filter ||
           std::memcmp(replay.outputs[same].data(), replay.outputs[r].data(),
                       replay.outputs[r].size() * sizeof(double)) != 0) {
      ++same;
    }
    if (same == r) PrintMatrix(*replay.rows[r], replay.outputs[r]);
  }
}

nlohmann::ordered_json AsJson(const Replay& replay, const Examiner& examiner) {
  using Json = nlohmann::ordered_json;
  const auto hex = [](const std::vector<double>& values) {
    Json array = Json::array();
    for (double v : values) array.push_back(HexFloat(v));
    return array;
  };
  const auto optional = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
  const ConfigurationFigures& c = examiner.Configuration();
  Json json = {{"energy", replay.chosen->energy->name},
               {"distribution", replay.plan.distribution->name},
               {"seed", replay.plan.seed},
               {"index", replay.index},
               {"x", hex(replay.x)},
               {"p", hex(replay.p)},
               {"in_domain", c.in_domain},
               {"active", c.active},
               {"indefinite", c.indefinite},
               {"eigenvalues", hex(replay.eigenvalues)}};
  for (std::size_t r = 0; r < replay.rows.size(); ++r) {
    const RowFigures& f = examiner.Row(r);
    json["rows"].push_back({{"kernel", replay.rows[r]->name},
                            {"distance", optional(f.distance)},
                            {"excess", optional(f.excess)},
                            {"rounding", optional(f.rounding)},
                            {"conditioned_rounding", optional(f.conditioned_rounding)},
                            {"psd_defect", optional(f.psd_defect)},
                            {"majorises", optional(f.majorises)},
                            {"relabelling", optional(f.relabelling)},
                            {"verdict", kVerdictNames[static_cast<std::size_t>(f.verdict)]},
                            {"matrix", hex(replay.outputs[r])}});
  }
  return json;
}

// Exit 1 if the row asked for breaks a promise here.
int RunReplay(const ReplayOptions& options) {
  const Replay replay = Load(options);
  Examiner examiner(*replay.chosen->energy, replay.rows);
  examiner.Examine(replay.x.data(), replay.p.data(), Depth::kTruth);
  if (options.json) {
    fmt::print("{}\n", AsJson(replay, examiner).dump(2));
  } else {
    Print(replay, examiner);
  }
  for (std::size_t r = 0; r < replay.rows.size(); ++r) {
    if (replay.rows[r] != replay.chosen) continue;
    for (Property property : examiner.Row(r).broken) {
      fmt::print(stderr, "{} promises to be {} and is not\n", replay.chosen->name,
                 PropertyName(property));
    }
    if (!examiner.Row(r).broken.empty()) return kBroken;
  }
  return kOk;
}

}  // namespace

void AddReplay(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "Shows one configuration whole: inputs, eigenvalues, filters, verdicts");
  command->add_option("--kernel", options->kernel, "Full name of a row (required)")
      ->type_name("NAME")
      ->required();
  AddDistributionOption(*command, options->distribution);
  AddSeedOption(*command, options->seed);
  AddSetOption(*command, options->overrides);
  command->add_option("--index", options->index, "Index of the configuration (required)")
      ->type_name("N")
      ->required();
  command->add_flag("--json", options->json, "As JSON, numbers as hex floats");
  command->footer(
      "Exit code 1 if the row asked for breaks one of its promises there.\n\nExample:\n"
      "  definite replay --kernel collision/vertex_face/signed/quadratic/analytic/f64x8 \\\n"
      "    --distribution paper --seed 42 --index 1234567");
  command->callback([options, &exit_code] { exit_code = RunReplay(*options); });
}

}  // namespace definite
