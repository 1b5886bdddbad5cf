#include "fuzz/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "fuzz/children.hpp"

namespace definite::fuzz {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kCasesTogether = 512;

std::vector<const KernelRow*> RowsOf(const Plan& plan, const Cell& cell,
                                     const std::vector<Crash>& crashes) {
  std::vector<const KernelRow*> rows;
  for (const KernelRow* row : plan.rows) {
    if (row->energy != cell.energy) continue;
    if (std::ranges::find(crashes, row, &Crash::row) == crashes.end()) rows.push_back(row);
  }
  return rows;
}

SweepPlan SweepOf(const Plan& plan, const Cell& cell, const std::vector<Crash>& crashes) {
  SweepPlan sweep;
  sweep.rows = RowsOf(plan, cell, crashes);
  sweep.distribution = FindFamily(cell.Distribution());
  sweep.samples = plan.samples;
  sweep.seed = cell.seed;
  sweep.count = plan.each;
  sweep.worst_cases = plan.worst_cases;
  sweep.timing = false;
  return sweep;
}

// JSON has no infinity.
Json Number(double value) {
  return std::isfinite(value) ? Json(value) : Json(std::isnan(value) ? "nan" : "inf");
}

// Those of the sample, and the greatest with what float128 found in worst cases.
Json FigureJson(const Figure& figure, const Figure& of_worst_cases = {}) {
  Figure all = figure;
  all.Merge(of_worst_cases);
  const auto summary = figure.Summarize(), whole = all.Summarize();
  if (!whole) return nullptr;
  Json json;
  json["median"] = summary ? Number(summary->median) : Json();
  json["p99"] = summary ? Number(summary->p99) : Json();
  json["max"] = Number(whole->max.value);
  json["index"] = whole->max.index;
  return json;
}

Json RowJson(const RowResult& r) {
  const RowStatistics& s = r.statistics;
  Json json;
  json["kernels"] = {r.row->name};
  json["verdicts"] = Json::object();
  for (std::size_t v = 0; v < s.verdicts.size(); ++v) {
    if (s.verdicts[v]) json["verdicts"][std::string(kVerdictNames[v])] = s.verdicts[v];
  }
  json["distance"] = FigureJson(s.distance);
  json["rounding"] = FigureJson(s.conditioned_rounding, r.of_worst_cases.conditioned_rounding);
  json["psd_defect"] = FigureJson(s.psd_defect);
  json["relabelling"] = FigureJson(s.relabelling);
  json["broken_promises"] = Json::array();
  RowStatistics all = s;
  all.Merge(r.of_worst_cases);
  for (const auto& [property, index] : all.broken) {
    json["broken_promises"].push_back({{"property", PropertyName(property)}, {"index", index}});
  }
  return json;
}

// Lanes give the same as scalars, as a rule: what is said of several rows of a filter is said once.
Json RowsJson(const std::vector<RowResult>& results) {
  Json rows = Json::array();
  std::vector<std::string_view> filters;  // of the rows
  for (const RowResult& r : results) {
    const Json row = RowJson(r);
    const auto is_same = [&](std::size_t i) {
      Json same = row;
      same["kernels"] = rows[i]["kernels"];
      return filters[i] == r.row->filter && same == rows[i];
    };
    std::size_t i = 0;
    while (i < rows.size() && !is_same(i)) ++i;
    if (i < rows.size()) {
      rows[i]["kernels"].push_back(r.row->name);
    } else {
      rows.push_back(row);
      filters.push_back(r.row->filter);
    }
  }
  return rows;
}

// Runs each row on each configuration, and notes before which.
void RunOneByOne(const SweepPlan& sweep, SharedNote& note) {
  Batch batch(*sweep.rows.front()->energy);
  std::vector<double> out;
  for (std::uint64_t index = 0; index < sweep.count; ++index) {
    if (index % kTile == 0) batch.Draw(*sweep.distribution, sweep.seed, index, kTile);
    const auto lane = static_cast<std::int64_t>(index % kTile);
    for (std::size_t r = 0; r < sweep.rows.size(); ++r) {
      note.Write(r, index);
      out.resize(static_cast<std::size_t>(sweep.rows[r]->outputs));
      RunOne(*sweep.rows[r], batch.X(lane), batch.P(lane), out.data());
    }
  }
}

// The case that ends a process, if one does alone.
Crash FindCrash(const Plan& plan, const Cell& cell, const std::vector<Crash>& earlier,
                const RunOptions& options, const std::string& how) {
  const SweepPlan sweep = SweepOf(plan, cell, earlier);
  Crash crash = {nullptr, 0, how};
  SharedNote note;
  const double cases = static_cast<double>(sweep.count * sweep.rows.size());
  const auto work = [&](std::size_t) {
    RunOneByOne(sweep, note);
    return std::string();
  };
  // A kernel takes microseconds: all cases together are far within the time of one that hangs.
  InChildren(1, 1, options.case_seconds + 1e-3 * cases, work, [&](std::size_t, const Ended& ended) {
    if (!ended.well) crash = {sweep.rows[note.First()], note.Second(), ended.text};
  });
  return crash;
}

}  // namespace

std::string Cell::Distribution() const { return fmt::format("fuzz/{}/{}", family->name, decade); }

std::string Cell::Name() const {
  return fmt::format("{} {} seed {}", energy->name, Distribution(), seed);
}

std::vector<Cell> CellsOf(const Plan& plan) {
  std::vector<const EnergyRow*> energies;
  for (const KernelRow* row : plan.rows) {
    if (std::ranges::find(energies, row->energy) == energies.end()) energies.push_back(row->energy);
  }
  std::vector<Cell> cells;
  for (std::uint64_t pass = 0; pass < plan.passes; ++pass) {
    for (int decade = 0; decade < kDecades; ++decade) {
      for (const Family* family : plan.families) {
        for (const EnergyRow* energy : energies) {
          if (!family->Has(energy->stencil)) continue;
          cells.push_back({plan.seed + pass, energy, family, decade});
        }
      }
    }
  }
  return cells;
}

std::string NameOf(const Json& cell) {
  return fmt::format("{} fuzz/{}/{} seed {}", cell.at("energy").get<std::string>(),
                     cell.at("family").get<std::string>(), cell.at("decade").get<int>(),
                     cell.at("seed").get<std::uint64_t>());
}

Json ToJson(const Plan& plan) {
  Json json = {{"families", Json::array()},
               {"kernels", Json::array()},
               {"seed", plan.seed},
               {"passes", plan.passes},
               {"each", plan.each},
               {"samples",
                {{"definition", plan.samples.definition},
                 {"spectrum", plan.samples.spectrum},
                 {"truth", plan.samples.truth}}},
               {"worst_cases", plan.worst_cases}};
  for (const Family* family : plan.families) json["families"].push_back(family->name);
  for (const KernelRow* row : plan.rows) json["kernels"].push_back(row->name);
  return json;
}

Json Check(const Plan& plan, const Cell& cell, std::vector<Crash> crashes) {
  const SweepPlan sweep = SweepOf(plan, cell, crashes);
  Json json = {{"energy", cell.energy->name},
               {"family", cell.family->name},
               {"decade", cell.decade},
               {"seed", cell.seed},
               {"count", plan.each},
               {"active", 0},
               {"indefinite", 0},
               {"out_of_domain", 0},
               {"rows", Json::array()}};
  if (!sweep.rows.empty()) {
    Progress silent(false);
    const SweepResult result = RunSweep(sweep, silent);
    const EnergyResult& energy = result.energies.front();
    json["active"] = energy.statistics.active;
    json["indefinite"] = energy.statistics.indefinite;
    json["out_of_domain"] = energy.statistics.out_of_domain;
    json["rows"] = RowsJson(energy.rows);
  }
  json["crashes"] = Json::array();
  for (const Crash& crash : crashes) {
    json["crashes"].push_back({{"kernel", crash.row ? Json(crash.row->name) : Json()},
                               {"index", crash.index},
                               {"how", crash.how}});
  }
  return json;
}

void Run(const Plan& plan, const std::vector<Cell>& cells, const RunOptions& options,
         const std::function<void(const Cell&, Json)>& done) {
  struct Attempt {
    std::vector<const Cell*> cells;
    std::vector<Crash> crashes;
  };
  // A process takes milliseconds to start: small cells share one, until something happens to it.
  const std::size_t together = std::clamp<std::size_t>(kCasesTogether / plan.each, 1, 32);
  std::vector<Attempt> attempts;
  for (const Cell& cell : cells) {
    if (attempts.empty() || attempts.back().cells.size() == together) attempts.push_back({});
    attempts.back().cells.push_back(&cell);
  }
  const auto judge = [&](std::size_t i) {
    Json judged = Json::array();
    for (const Cell* cell : attempts[i].cells) {
      judged.push_back(Check(plan, *cell, attempts[i].crashes));
    }
    return judged.dump();
  };
  while (!attempts.empty() && !Interrupted()) {
    std::vector<std::pair<std::size_t, std::string>> died;
    InChildren(attempts.size(), options.processes, options.cell_seconds, judge,
               [&](std::size_t i, const Ended& ended) {
                 if (!ended.well) {
                   died.emplace_back(i, ended.text);
                   return;
                 }
                 const Json judged = Json::parse(ended.text);
                 for (std::size_t k = 0; k < judged.size(); ++k) {
                   done(*attempts[i].cells[k], judged[k]);
                 }
               });
    std::vector<Attempt> again;
    for (const auto& [i, how] : died) {
      Attempt attempt = std::move(attempts[i]);
      if (attempt.cells.size() > 1) {
        for (const Cell* cell : attempt.cells) again.push_back({{cell}, {}});
        continue;
      }
      // Without the row that it was.
      const Cell& cell = *attempt.cells.front();
      attempt.crashes.push_back(FindCrash(plan, cell, attempt.crashes, options, how));
      if (attempt.crashes.back().row) {
        again.push_back(std::move(attempt));
      } else if (!Interrupted()) {
        // Whatever it is that died, it is not judged.
        Plan none = plan;
        none.rows.clear();
        done(cell, Check(none, cell, attempt.crashes));
      }
    }
    attempts = std::move(again);
  }
}

}  // namespace definite::fuzz
