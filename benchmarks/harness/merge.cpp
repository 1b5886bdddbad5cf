#include "benchmarks/harness/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <utility>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/promises.hpp"
#include "benchmarks/harness/report.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

// A number, or how JSON writes infinity.
double NumberFrom(const Json& value) {
  if (!value.is_string()) return value.get<double>();
  if (value == "inf") return std::numeric_limits<double>::infinity();
  throw MergeError(fmt::format("{}: expected a number", value.dump()));
}

std::uint64_t Hex(const Json& value) {
  const auto& text = value.get_ref<const std::string&>();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw MergeError(fmt::format("'{}': expected 16 hexadecimal digits", text));
  }
  return number;
}

Figure FigureOf(const Json& json) {
  if (json.is_null()) return {};
  const auto nan = json.at("nan").get<std::uint64_t>();
  if (json.at("count") == 0)
    return Figure::Of({}, std::numeric_limits<double>::infinity(), {}, nan);
  Histogram values;
  for (const Json& bucket : json.at("histogram")) {
    values.Add(NumberFrom(bucket.at(0)), bucket.at(1).get<std::uint64_t>());
  }
  if (values.Count() != json.at("count")) {
    throw MergeError(fmt::format("a histogram holds {} values, its figure {}", values.Count(),
                                 json.at("count").dump()));
  }
  const Json& max = json.at("max");
  return Figure::Of(std::move(values), NumberFrom(json.at("min")),
                    {NumberFrom(max.at("value")), max.at("index").get<std::uint64_t>()}, nan);
}

RowStatistics RowStatisticsOf(const Json& row) {
  RowStatistics s;
  const Json& accuracy = row.at("accuracy");
  s.distance = FigureOf(accuracy.at("distance"));
  s.excess = FigureOf(accuracy.at("excess"));
  s.psd_defect = FigureOf(accuracy.at("psd_defect"));
  s.majorises = FigureOf(accuracy.at("majorises"));
  s.relabelling = FigureOf(accuracy.at("relabelling"));
  s.rounding = FigureOf(accuracy.at("rounding"));
  s.conditioned_rounding = FigureOf(accuracy.at("conditioned_rounding"));
  s.flips = accuracy.at("flips");
  s.flip_checks = accuracy.at("flip_checks");
  s.defined = accuracy.at("defined");
  for (std::size_t v = 0; v < s.verdicts.size(); ++v) {
    s.verdicts[v] = row.at("verdicts").at(std::string(kVerdictNames[v]));
  }
  for (const Json& broken : row.at("broken_promises")) {
    const auto property = PropertyNamed(broken.at("property").get<std::string>());
    if (!property) throw MergeError(broken.at("property").dump() + ": there is no such promise");
    s.broken[*property] = broken.at("index");
  }
  s.checksum = Hex(row.at("checksum"));
  return s;
}

EnergyStatistics EnergyStatisticsOf(const Json& row) {
  EnergyStatistics e;
  e.count = row.at("count");
  e.active = row.at("active");
  e.indefinite = row.at("indefinite");
  e.out_of_domain = row.at("out_of_domain");
  e.value_rounding = FigureOf(row.at("accuracy").at("value_rounding"));
  e.gradient_rounding = FigureOf(row.at("accuracy").at("gradient_rounding"));
  return e;
}

const Distribution* DistributionOf(const Json& plan) {
  const auto name = plan.at("distribution").get<std::string>();
  const Distribution* distribution = FindDistribution(name);
  if (!distribution) throw MergeError(name + ": this program has no such distribution");
  if (RecordedToJson(*distribution) != plan.value("recorded", Json())) {
    throw MergeError(name + ": the file is not the one that was read then");
  }
  return distribution;
}

SweepPlan PlanOf(const Json& json) {
  SweepPlan plan;
  for (const Json& name : json.at("kernels")) {
    plan.rows.push_back(FindKernel(name.get<std::string>()));
    if (!plan.rows.back()) throw MergeError(name.dump() + ": this program has no such row");
  }
  plan.distribution = DistributionOf(json);
  for (const auto& [name, value] : json.at("set").items()) {
    const Parameter* known = nullptr;
    for (const KernelRow* row : plan.rows) {
      for (const Parameter& parameter : row->energy->parameters) {
        if (parameter.name == name) known = &parameter;
      }
    }
    if (!known) throw MergeError(name + ": no energy of the plan has this parameter");
    plan.overrides.push_back({known->name, value.get<double>()});
  }
  plan.seed = json.at("seed");
  plan.count = json.at("count");
  const Json& samples = json.at("samples");
  plan.samples = {samples.at("definition"), samples.at("spectrum"), samples.at("truth")};
  plan.timing = false;
  return plan;
}

void ReadBlocks(const Json& json, const SweepPlan& plan, EnergyResult& energy) {
  std::uint64_t configurations = 0;
  for (const Json& block : json.at(energy.energy->name)) {
    const auto first = block.at(0).get<std::uint64_t>();
    if (first >= plan.count || first % BlockSize(plan.count) != 0) {
      throw MergeError(fmt::format("{}: no block begins at {}", energy.energy->name, first));
    }
    energy.blocks[first] = Hex(block.at(1));
    configurations += BlockAt(first, plan.count).Size();
  }
  if (configurations != energy.statistics.count) {
    throw MergeError(fmt::format("{}: its blocks hold {} configurations, its rows {}",
                                 energy.energy->name, configurations, energy.statistics.count));
  }
}

SweepResult Read(const Json& json) {
  if (!json.contains("plan")) {
    throw MergeError("expected the result of a sweep, written with its histograms");
  }
  // The statistics hang on the code: they are those of one program.
  const Json here = DescribeBuild();
  for (const auto& [key, value] : json.at("build").items()) {
    if (here.at(key) != value) {
      throw MergeError(fmt::format("made by another program: its {} is '{}', here it is '{}'", key,
                                   value.get<std::string>(), here.at(key).get<std::string>()));
    }
  }
  if (json.at("protocol") != ProtocolHash()) throw MergeError("made under another protocol");
  SweepResult result = Prepare(PlanOf(json.at("plan")));
  std::size_t at = 0;
  for (EnergyResult& energy : result.energies) {
    for (RowResult& r : energy.rows) {
      const Json& row = json.at("rows").at(at++);
      if (row.at("kernel") != r.row->name) {
        throw MergeError(
            fmt::format("expected the row {}, found {}", r.row->name, row.at("kernel").dump()));
      }
      r.statistics = RowStatisticsOf(row);
      energy.statistics = EnergyStatisticsOf(row);  // each row has them
    }
    ReadBlocks(json.at("blocks"), result.plan, energy);
  }
  return result;
}

// What the plan is, but for who does which part of it.
Json Identity(const SweepResult& result) {
  return ToJson(result, {}, Detail::kCanonical).at("plan");
}

void RequireOnePlan(std::span<const SweepResult> parts) {
  const Json plan = Identity(parts.front());
  for (const SweepResult& part : parts.subspan(1)) {
    const Json other = Identity(part);
    for (const auto& [key, value] : plan.items()) {
      if (other.at(key) != value) {
        throw MergeError(fmt::format("these are parts of two plans: {} {} and {}", key,
                                     value.dump(), other.at(key).dump()));
      }
    }
  }
}

using Blocks = std::map<std::uint64_t, std::uint64_t>;
using EnergyParts = std::vector<const EnergyResult*>;

// All blocks of the parts; throws if two parts have different outputs of one.
Blocks UnionOf(const EnergyParts& parts) {
  Blocks all;
  for (const EnergyResult* part : parts) {
    for (const auto& [first, digest] : part->blocks) {
      if (all.try_emplace(first, digest).first->second == digest) continue;
      throw MergeError(fmt::format("{}: two parts have different outputs of the block at {}",
                                   part->energy->name, first));
    }
  }
  return all;
}

// Chooses parts so that each block left is in exactly one of them; false if there are none. Tries
// the parts in their order.
bool Cover(const EnergyParts& parts, Blocks left, EnergyParts& chosen) {
  if (left.empty()) return true;
  const std::uint64_t first = left.begin()->first;
  for (const EnergyResult* part : parts) {
    const bool fits =
        part->blocks.contains(first) && std::ranges::all_of(part->blocks, [&](const auto& block) {
          return left.contains(block.first);
        });
    if (!fits) continue;
    Blocks rest = left;
    for (const auto& [block, digest] : part->blocks) rest.erase(block);
    chosen.push_back(part);
    if (Cover(parts, std::move(rest), chosen)) return true;
    chosen.pop_back();
  }
  return false;
}

// Statistics cannot be taken apart again: parts that lie side by side make the whole, and what else
// there is must agree with it.
void MergeEnergy(EnergyParts parts, EnergyResult& sum) {
  sum.blocks = UnionOf(parts);
  std::ranges::stable_sort(parts, {}, [](const EnergyResult* part) {
    return -static_cast<std::ptrdiff_t>(part->blocks.size());
  });
  EnergyParts chosen;
  if (!Cover(parts, sum.blocks, chosen)) {
    throw MergeError(fmt::format(
        "{}: two parts overlap and neither lies within the other; give the shards that they were "
        "made of",
        sum.energy->name));
  }
  for (const EnergyResult* part : chosen) {
    sum.statistics.Merge(part->statistics);
    for (std::size_t r = 0; r < sum.rows.size(); ++r) {
      sum.rows[r].statistics.Merge(part->rows[r].statistics);
    }
  }
}

}  // namespace

SweepResult FromJson(const Json& json) {
  try {
    return Read(json);
  } catch (const nlohmann::json::exception& error) {
    throw MergeError(
        fmt::format("not the result of a sweep as results/schema.json has it: {}", error.what()));
  }
}

SweepResult Merge(std::span<const SweepResult> parts) {
  RequireOnePlan(parts);
  SweepResult sum = Prepare(parts.front().plan);
  for (std::size_t e = 0; e < sum.energies.size(); ++e) {
    EnergyParts of_energy;
    for (const SweepResult& part : parts) of_energy.push_back(&part.energies[e]);
    MergeEnergy(std::move(of_energy), sum.energies[e]);
  }
  sum.partial = !IsWhole(sum);
  return sum;
}

std::string DescribeMissing(const SweepResult& result) {
  const std::size_t all = BlocksOf(result.plan.count, {}).size();
  std::size_t least = all;
  const EnergyResult* which = nullptr;
  for (const EnergyResult& energy : result.energies) {
    if (energy.blocks.size() >= least) continue;
    least = energy.blocks.size();
    which = &energy;
  }
  if (!which) return "none";
  return fmt::format("of {} energies; {} has {} of {} blocks",
                     std::ranges::count_if(
                         result.energies,
                         [all](const EnergyResult& energy) { return energy.blocks.size() < all; }),
                     which->energy->name, least, all);
}

std::string CanonicalText(const SweepResult& result) {
  return Dump(ToJson(result, {}, Detail::kCanonical), Detail::kCanonical);
}

}  // namespace definite
