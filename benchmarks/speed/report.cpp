#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/harness/machine.hpp"
#include "benchmarks/harness/report.hpp"
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

std::string_view WithoutScalar(const KernelRow& row) {
  return std::string_view(row.name).substr(0, row.name.rfind('/'));
}

// The same job on the first number of threads over this one.
template <class Time, class Seconds>
std::string SpeedUp(const std::vector<Time>& all, const Time& one, Seconds seconds) {
  for (const Time& first : all) {
    if (first.row != one.row) continue;
    return first.threads == one.threads ? "1"
                                        : fmt::format("{:.2f}", seconds(first) / seconds(one));
  }
  return "";
}

std::string JobTable(const SpeedResult& result) {
  if (result.jobs.empty()) return "";
  const JobTime& any = result.jobs.front();
  std::string table = fmt::format(
      "\nThe whole job: {:.3g} configurations of {}, drawn and filtered over lanes, outputs in "
      "L1;\n"
      "wall time, ns each. Hessian: filtered, less the frame; write: packed, less both.\n",
      static_cast<double>(any.count), result.plan.distribution->name);
  table += fmt::format("{:<56}{:>2}{:>6}{:>6}{:>8}{:>6}{:>7}{:>6}\n", "", "T", "draw", "frame",
                       "Hessian", "write", "s", "x");
  for (const JobTime& job : result.jobs) {
    const auto ns = [&job](double seconds) {
      return seconds * 1e9 / static_cast<double>(job.count);
    };
    table += fmt::format("{:<56}{:>2}{:>6.1f}{:>6.1f}{:>8.1f}{:>6.1f}{:>7.2f}{:>6}\n",
                         WithoutScalar(*job.row), job.threads, ns(job.draw), ns(job.frame),
                         ns(job.hessian - job.frame), ns(job.packed - job.hessian), job.Total(),
                         SpeedUp(result.jobs, job, [](const JobTime& t) { return t.Total(); }));
  }
  return table;
}

std::string AssemblyTable(const SpeedResult& result) {
  if (result.assemblies.empty()) return "";
  const AssemblyTime& any = result.assemblies.front();
  std::string table = fmt::format(
      "\nScatter-add: {:.3g} elements gathered, filtered and added to {:.3g} 3x3 blocks, colour "
      "by\n"
      "colour ({} of them); wall time, ns each, beside the row alone on one thread\n",
      static_cast<double>(any.elements), static_cast<double>(any.blocks), any.colours);
  table += fmt::format("{:<56}{:>2}{:>8}{:>11}{:>6}\n", "", "T", "row", "scattered", "x");
  const auto median = [](const std::vector<double>& seconds) {
    const auto e = EstimateMedian(seconds);
    return e ? e->median : 0;
  };
  for (const AssemblyTime& time : result.assemblies) {
    table += fmt::format("{:<56}{:>2}{:>8.1f}{:>11.1f}{:>6}\n", WithoutScalar(*time.row),
                         time.threads, median(time.kernel) * 1e9, median(time.assembled) * 1e9,
                         SpeedUp(result.assemblies, time,
                                 [&](const AssemblyTime& t) { return median(t.assembled); }));
  }
  return table;
}

}  // namespace

Json ToJson(const SpeedResult& result, const std::vector<std::string>& command) {
  Json json =
      ResultHead(command, result.plan.seed, result.partial, result.load_before, result.noisy);
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
    for (double seconds : row.seconds) {
      speed["rows"].back()["samples"].push_back(1e9 * seconds);
    }
  }
  speed["jobs"] = Json::array();
  for (const JobTime& job : result.jobs) {
    speed["jobs"].push_back({{"kernel", job.row->name},
                             {"threads", job.threads},
                             {"count", job.count},
                             {"seconds",
                              {{"draw", job.draw},
                               {"frame", job.frame},
                               {"hessian", job.hessian},
                               {"packed", job.packed},
                               {"total", job.Total()}}}});
  }
  speed["assemblies"] = Json::array();
  for (const AssemblyTime& time : result.assemblies) {
    speed["assemblies"].push_back({{"kernel", time.row->name},
                                   {"threads", time.threads},
                                   {"elements", time.elements},
                                   {"blocks", time.blocks},
                                   {"colours", time.colours},
                                   {"rounds", time.assembled.size()},
                                   {"kernel_ns", ToJson(EstimateMedian(time.kernel), 1e9)},
                                   {"assembled_ns", ToJson(EstimateMedian(time.assembled), 1e9)}});
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
  return table + JobTable(result) + AssemblyTable(result);
}

}  // namespace definite
