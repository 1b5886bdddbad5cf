#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/speed/speed.hpp"
#include "kernels/core/lanes.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const std::optional<MedianEstimate>& e, double factor) {
  if (!e) return nullptr;
  return {{"median", e->median * factor},
          {"minimum", e->minimum * factor},
          {"low", e->low * factor},
          {"high", e->high * factor}};
}

Json ToJson(const std::optional<Floor>& floor) {
  if (!floor) return nullptr;
  const auto each = [&](std::int64_t operations) {
    return static_cast<double>(operations) / static_cast<double>(floor->counted);
  };
  const Operations& o = floor->operations;
  return {{"ns", floor->Seconds() * 1e9},
          {"binds", floor->Binds()},
          {"arithmetic_ns", floor->arithmetic * 1e9},
          {"division_ns", floor->division * 1e9},
          {"stores_ns", floor->stores * 1e9},
          {"operations",
           {{"additions", each(o.additions)},
            {"multiplications", each(o.multiplications)},
            {"fused", each(o.fused)},
            {"divisions", each(o.divisions)},
            {"roots", each(o.roots)},
            {"logs", each(o.logs)},
            {"stores", each(o.stores)}}}};
}

std::string Number(const std::optional<MedianEstimate>& e) {
  if (!e) return "-";
  return fmt::format("{:.{}f}", e->median, e->median < 10 ? 2 : e->median < 100 ? 1 : 0);
}

}  // namespace

Json ToJson(const SpeedResult& result, const std::vector<std::string>& command) {
  Json json;
  json["schema"] = "definite/1";
  json["protocol"] = ProtocolHash();
  json["command"] = command;
  json["machine"] = DescribeMachine(result.load_before, result.noisy);
  json["build"] = DescribeBuild();
  json["seed"] = result.plan.seed;
  json["partial"] = result.partial;
  json["rows"] = Json::array();
  const Roofline& r = result.roofline;
  Json& speed = json["speed"];
  speed["distribution"] = result.plan.distribution->name;
  speed["roofline"] = {{"lanes", kNativeLanes},
                       {"fused_per_second", r.fused},
                       {"arithmetic_per_second", r.arithmetic},
                       {"divisions_per_second", r.divisions},
                       {"roots_per_second", r.roots},
                       {"store_bytes_per_second",
                        {{"L1", r.Stores(Level::kL1)},
                         {"L2", r.Stores(Level::kL2)},
                         {"memory", r.Stores(Level::kMemory)}}}};
  speed["rows"] = Json::array();
  for (const SpeedRow& row : result.rows) {
    speed["rows"].push_back({{"kernel", row.row->name},
                             {"output", row.row->output},
                             {"ring", LevelName(row.level)},
                             {"threads", row.threads},
                             {"clock", row.threads == 1 ? "thread_cpu" : "wall"},
                             {"rounds", row.seconds.size()},
                             {"ns_per_hessian", ToJson(EstimateMedian(row.seconds), 1e9)},
                             {"ratio_to",
                              {{"numeric", ToJson(row.to_numeric, 1)},
                               {"gauss_newton", ToJson(row.to_gauss_newton, 1)}}},
                             {"floor", ToJson(row.floor)}});
  }
  return json;
}

std::string ToTable(const SpeedResult& result) {
  const Roofline& r = result.roofline;
  std::string table = fmt::format(
      "{} lanes; a core does {:.2f} G vector operations a second, fused multiply-adds {:.2f} G\n"
      "({:.0f} GFlop/s), divisions {:.2f} G, square roots {:.2f} G; it stores {:.0f} GB/s in L1, "
      "{:.0f} in L2,\n{:.0f} in memory\n",
      kNativeLanes, r.arithmetic * 1e-9, r.fused * 1e-9, 2e-9 * kNativeLanes * r.fused,
      r.divisions * 1e-9, r.roots * 1e-9, r.Stores(Level::kL1) * 1e-9, r.Stores(Level::kL2) * 1e-9,
      r.Stores(Level::kMemory) * 1e-9);
  const SpeedRow* last = nullptr;
  for (const SpeedRow& row : result.rows) {
    if (!last || last->row->energy != row.row->energy || last->level != row.level ||
        last->threads != row.threads) {
      table += fmt::format("\n{}, {}, outputs in {}, {} thread{}\n", row.row->energy->name,
                           result.plan.distribution->name, LevelName(row.level), row.threads,
                           row.threads == 1 ? "" : "s");
      table += fmt::format("{:<30}{:>8}{:>18}{:>9}{:>7}{:>8}{:>7}  {}\n", "", "ns", "95 %",
                           "numeric/", "G-N/", "floor", "x", "binds");
    }
    last = &row;
    const auto time = EstimateMedian(row.seconds);
    const std::string name(row.row->name.substr(row.row->energy->name.size() + 1));
    table += fmt::format(
        "{:<30}{:>8}{:>18}{:>9}{:>7}{:>8}{:>7}{}\n", name,
        time ? fmt::format("{:.1f}", time->median * 1e9) : "-",
        time ? fmt::format("{:.1f} - {:.1f}", time->low * 1e9, time->high * 1e9) : "",
        Number(row.to_numeric), Number(row.to_gauss_newton),
        row.floor ? fmt::format("{:.1f}", row.floor->Seconds() * 1e9) : "-",
        row.floor && time ? fmt::format("{:.1f}", time->median / row.floor->Seconds()) : "-",
        row.floor ? fmt::format("  {}", row.floor->Binds()) : "");
  }
  return table;
}

}  // namespace definite
