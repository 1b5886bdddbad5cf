#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "benchmarks/plans/markdown.hpp"
#include "benchmarks/plans/plan.hpp"
#include "benchmarks/plans/result.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

// In which order tables have what they know; what is new comes last.
constexpr std::array<std::string_view, 4> kPrimitives = {"vertex_face", "edge_edge", "vertex_edge",
                                                         "vertex_vertex"};
constexpr std::array<std::string_view, 5> kLengths = {"signed", "unsigned", "unsigned_frozen",
                                                      "hybrid", "anisotropic"};
constexpr std::array<std::string_view, 3> kPenalties = {"quadratic", "cubic", "log_barrier"};
constexpr std::array<std::string_view, 9> kFilters = {
    "none",       "gauss_newton",     "analytic", "split",  "absolute",
    "blend_half", "absolute_numeric", "numeric",  "nearest"};
constexpr std::array<std::string_view, 3> kDistributions = {"active", "normal", "paper"};

template <std::size_t kCount>
std::size_t RankOf(std::string_view name, const std::array<std::string_view, kCount>& order) {
  return static_cast<std::size_t>(std::ranges::find(order, name) - order.begin());
}

// A filter that is another one, computed in another way: through the frame, as printed, or by
// another eigensolver; or a baseline that only a few energies have.
bool IsDuplicate(std::string_view filter) {
  return filter.ends_with("_frame") || filter.ends_with("_printed") ||
         filter.starts_with("numeric_") || filter.starts_with("ql_") ||
         filter.starts_with("jacobi_") || filter.starts_with("shift_") || filter == "vertex_blocks";
}

std::vector<PlannedSweep> Sweeps() {
  std::vector<std::string> rows;
  for (const KernelRow& row : AllKernels()) {
    if (row.name.starts_with("collision/") && row.scalar == "f64" && !IsDuplicate(row.filter)) {
      rows.push_back(row.name);
    }
  }
  std::vector<PlannedSweep> sweeps;
  for (const Distribution& distribution : AllDistributions()) {
    sweeps.push_back({rows, distribution.name, {}});
  }
  return sweeps;
}

// "collision/vertex_face/signed/quadratic" in parts.
struct EnergyName {
  std::string primitive, length, penalty;

  explicit EnergyName(const std::string& name) {
    const std::size_t first = name.find('/') + 1, second = name.find('/', first) + 1;
    const std::size_t third = name.rfind('/') + 1;
    primitive = name.substr(first, second - 1 - first);
    length = name.substr(second, third - 1 - second);
    penalty = name.substr(third);
  }
  auto Rank() const {
    return std::tuple(RankOf(primitive, kPrimitives), primitive, RankOf(length, kLengths), length,
                      RankOf(penalty, kPenalties), penalty);
  }
};

// The rows of one energy over one distribution, by filter.
using RowsOfEnergy = std::vector<const Json*>;

struct Table {
  std::vector<std::string> energies, distributions;  // in the order of the tables
  std::map<std::pair<std::string, std::string>, RowsOfEnergy> rows;

  explicit Table(const Json& result) {
    for (const Json& row : result.at("rows")) {
      const std::string energy = row.at("energy"), distribution = row.at("distribution");
      AddOnce(energies, energy);
      AddOnce(distributions, distribution);
      rows[{energy, distribution}].push_back(&row);
    }
    std::ranges::stable_sort(energies, {},
                             [](const std::string& e) { return EnergyName(e).Rank(); });
    std::ranges::stable_sort(distributions, {},
                             [](const std::string& d) { return RankOf(d, kDistributions); });
    for (auto& [of, some] : rows) {
      std::ranges::stable_sort(some, {}, [](const Json* row) {
        return RankOf(row->at("filter").get<std::string>(), kFilters);
      });
    }
  }

  // Null if there is none.
  const Json* Row(const std::string& energy, const std::string& distribution,
                  const std::string& filter) const {
    const auto at = rows.find({energy, distribution});
    if (at == rows.end()) return nullptr;
    for (const Json* row : at->second) {
      if (row->at("filter") == filter) return row;
    }
    return nullptr;
  }

 private:
  static void AddOnce(std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
};

// In at most five characters.
std::string Shorter(const std::optional<double>& value) {
  if (!value) return "-";
  const double size = std::abs(*value);
  if (size == 0) return "0";
  if (size < 9.5e-4 || size >= 9999.5) return fmt::format("{:.0e}", *value);
  return fmt::format(fmt::runtime(size < 9.5e-3 ? "{:.1g}"
                                  : size < 99.5 ? "{:.2g}"
                                                : "{:.0f}"),
                     *value);
}

const std::array<std::string, 4> kAtAGlance = {"gauss_newton", "analytic", "split", "absolute"};

std::string Summary(const Table& table, const std::string& distribution) {
  std::vector<std::vector<std::string>> cells = {
      {"median/p99", "gauss_newton", "analytic", "split", "absolute", "nearest"}};
  std::string primitive;
  for (const std::string& energy : table.energies) {
    if (!table.rows.count({energy, distribution})) continue;
    const EnergyName name(energy);
    if (name.primitive != primitive) {
      primitive = name.primitive;
      cells.push_back({"**" + primitive + "**", "", "", "", "", ""});
    }
    std::vector<std::string>& line = cells.emplace_back();
    line.push_back(name.length + "/" + name.penalty);
    for (const std::string& filter : kAtAGlance) {
      const Json* row = table.Row(energy, distribution, filter);
      line.push_back(row ? Shorter(Entry(*row, "distance", "median")) + "/" +
                               Shorter(Entry(*row, "distance", "p99"))
                         : "-");
    }
    const Json* nearest = table.Row(energy, distribution, "nearest");
    line.push_back(nearest ? Shorter(Entry(*nearest, "distance", "max")) : "-");
  }
  return MarkdownTable(cells);
}

std::uint64_t NotPsd(const Json& row) {
  const Json& verdicts = row.at("verdicts");
  return verdicts.at("non_psd").get<std::uint64_t>() +
         verdicts.at("non_finite").get<std::uint64_t>();
}

std::string DetailsOf(const RowsOfEnergy& rows) {
  const Json& first = *rows.front();
  std::string text =
      fmt::format("\n{}: {} pairs, {} % active, {} % of them indefinite\n\n",
                  first.at("distribution").get<std::string>(),
                  WithCommas(first.at("count").get<std::uint64_t>()),
                  Percent(first.at("active_fraction")), Percent(first.at("indefinite_fraction")));
  std::vector<std::vector<std::string>> cells = {
      {"filter", "median", "p99", "worst", "at", "excess", "worst", "relab.", "not PSD"}};
  for (const Json* row : rows) {
    const Json& distance = row->at("accuracy").at("distance");
    cells.push_back(
        {row->at("filter"), Short(Entry(*row, "distance", "median")),
         Short(Entry(*row, "distance", "p99")), Short(Entry(*row, "distance", "max")),
         distance.is_null() ? "-" : std::to_string(distance.at("max").at("index").get<long>()),
         Short(Entry(*row, "excess", "median")), Short(Entry(*row, "excess", "max")),
         Short(Entry(*row, "relabelling", "max")), std::to_string(NotPsd(*row))});
  }
  return text + MarkdownTable(cells);
}

// Of how many pairs the relabelling spread was measured, at most.
std::uint64_t Relabelled(const Json& result) {
  std::uint64_t most = 0;
  for (const Json& row : result.at("rows")) {
    const Json& figure = row.at("accuracy").at("relabelling");
    if (!figure.is_null()) most = std::max(most, figure.at("count").get<std::uint64_t>());
  }
  return most;
}

std::string Markdown(const Json& result) {
  const Table table(result);
  std::string text = "### At a glance\n";
  for (const std::string& distribution : table.distributions) {
    text += fmt::format("\n#### `{}`\n\n{}", distribution, Summary(table, distribution));
  }
  text += "\n### In full\n" +
          Paragraph(fmt::format(
              "Distance: median, p99, worst, and at: the index of the worst. Excess: median and "
              "worst. relab.: worst relabelling spread, over {} of the pairs. not PSD: how many of "
              "the active results are not, or not finite. Seed {}.",
              WithCommas(Relabelled(result)), result.at("seed").get<std::uint64_t>()));
  for (const std::string& energy : table.energies) {
    text += fmt::format("\n#### {}\n", energy);
    for (const std::string& distribution : table.distributions) {
      const auto at = table.rows.find({energy, distribution});
      if (at != table.rows.end()) text += DetailsOf(at->second);
    }
  }
  return text + "\n### Where it was measured\n" + Provenance(result);
}

}  // namespace

Plan CollisionAccuracy() {
  return {"collision-accuracy",
          "every collision energy with every filter",
          "1e6",
          false,
          true,
          Detail::kBrief,
          {.definition = 1'000, .spectrum = 100'000, .truth = 100},
          Sweeps,
          nullptr,
          Markdown};
}

}  // namespace definite
