#include "benchmarks/harness/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "benchmarks/harness/clock.hpp"
#include "benchmarks/harness/sampling/batch.hpp"
#include "benchmarks/harness/timed_pass.hpp"

namespace definite {

namespace {

class System {
 public:
  explicit System(std::string root) : root_(std::move(root)) {}

  // The first line; nothing if there is no such file.
  std::optional<std::string> Line(const std::string& path) const {
    std::ifstream file(root_ + path);
    std::string line;
    if (!file || !std::getline(file, line)) return std::nullopt;
    return line;
  }
  bool Mentions(const std::string& path, const std::string& word) const {
    std::ifstream file(root_ + path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str().find(word) != std::string::npos;
  }

 private:
  std::string root_;
};

Symptom Governor(const System& system) {
  const auto governor = system.Line("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (!governor) {
    return {"governor", "unknown", "the clock rate may change, and nobody says when", Trust::kCare};
  }
  if (*governor == "performance") return {"governor", *governor, "", Trust::kGood};
  return {"governor", *governor, "the clock rate follows the load: set it to performance",
          Trust::kCare};
}

Symptom Turbo(const System& system) {
  if (const auto off = system.Line("sys/devices/system/cpu/intel_pstate/no_turbo")) {
    if (*off == "1") return {"turbo", "off", "", Trust::kGood};
    return {"turbo", "on", "the clock rate depends on temperature and on other cores",
            Trust::kCare};
  }
  if (const auto on = system.Line("sys/devices/system/cpu/cpufreq/boost")) {
    if (*on == "0") return {"turbo", "off", "", Trust::kGood};
    return {"turbo", "on", "the clock rate depends on temperature and on other cores",
            Trust::kCare};
  }
  return {"turbo", "unknown", "the clock rate may depend on other cores", Trust::kCare};
}

Symptom Load(const System& system) {
  const auto line = system.Line("proc/loadavg");
  if (!line) return {"load", "unknown", "", Trust::kCare};
  const double load = std::strtod(line->c_str(), nullptr);
  const std::string found = fmt::format("{:.2f}", load);
  if (load < 0.3) return {"load", found, "", Trust::kGood};
  const bool full = load >= std::max(1u, std::thread::hardware_concurrency());
  return {"load", found, "other work runs here: wait until it is done",
          full ? Trust::kBad : Trust::kCare};
}

Symptom Smt(const System& system) {
  const auto active = system.Line("sys/devices/system/cpu/smt/active");
  if (!active) return {"SMT", "unknown", "two threads may share a core", Trust::kCare};
  if (*active == "0") return {"SMT", "off", "", Trust::kGood};
  return {"SMT", "on", "two threads may share a core", Trust::kCare};
}

Symptom Virtual(const System& system) {
  if (system.Mentions("proc/cpuinfo", "hypervisor")) {
    return {"machine", "virtual",
            "neighbours on the host take caches, and the clock rate is theirs", Trust::kCare};
  }
  return {"machine", "real", "", Trust::kGood};
}

Symptom Quota(const System& system) {
  const auto quota = system.Line("sys/fs/cgroup/cpu.max");
  if (!quota || quota->starts_with("max")) return {"quota", "none", "", Trust::kGood};
  double most = 0, period = 0;
  std::istringstream(*quota) >> most >> period;
  return {"quota", fmt::format("{:.3g} cores", most / period),
          "a container that used up its share is stopped for a while: wall time shows it",
          Trust::kCare};
}

Symptom ClockStep() {
  double step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const double start = ThreadSeconds();
    double now = start;
    while (now == start) now = ThreadSeconds();
    step = std::min(step, now - start);
  }
  return {"clock", fmt::format("{:.0f} ns a step", 1e9 * step),
          step > 1e-5 ? "too coarse for what is timed here" : "",
          step > 1e-5 ? Trust::kBad : Trust::kGood};
}

// A row against itself, as rows are timed against each other.
std::vector<double> AgainstItself() {
  constexpr std::int64_t kConfigurations = 4096;
  constexpr int kRounds = 101, kPasses = 10;
  const KernelRow& row = AllKernels().front();
  const Distribution& distribution = *FindDistribution("active");
  Batch batch(*row.energy);
  batch.Draw(distribution, 1, 0, kConfigurations);
  AlignedDoubles ring;
  ring.Resize(static_cast<std::size_t>(row.outputs * kRing));
  const auto time = [&] {
    const double start = ThreadSeconds();
    for (int pass = 0; pass < kPasses; ++pass) {
      for (std::int64_t i = 0; i < kConfigurations; i += kRing) {
        row.run(batch.TilesX(row.lanes, i), batch.TilesP(row.lanes, i), ring.Data(),
                kRing / row.lanes);
        asm volatile("" : : "r"(ring.Data()) : "memory");
      }
    }
    return ThreadSeconds() - start;
  };
  std::vector<double> apart;
  time();
  for (int round = 0; round < kRounds; ++round) {
    const double a = time(), b = time();
    apart.push_back(std::abs(std::log(a / b)));
  }
  std::ranges::sort(apart);
  return apart;
}

Symptom Worth(const char* use, bool good, bool care, std::string why) {
  return {use,
          good   ? "yes"
          : care ? "with care"
                 : "no",
          good ? "" : std::move(why),
          good   ? Trust::kGood
          : care ? Trust::kCare
                 : Trust::kBad};
}

}  // namespace

Diagnosis Diagnose(const std::string& root) {
  const System system(root);
  Diagnosis diagnosis;
  diagnosis.symptoms = {Governor(system), Turbo(system), Load(system), Smt(system),
                        Virtual(system),  Quota(system), ClockStep()};
  const std::vector<double> apart = AgainstItself();
  diagnosis.typical = std::expm1(apart[apart.size() / 2]);
  diagnosis.floor = std::expm1(apart[apart.size() * 95 / 100]);
  const double floor = diagnosis.floor;
  diagnosis.symptoms.push_back(
      {"noise",
       fmt::format("{:.1f} % typical, {:.1f} % floor", 100 * diagnosis.typical, 100 * floor),
       floor > 0.02 ? "a row is that far from itself in one round" : "",
       floor > 0.2    ? Trust::kBad
       : floor > 0.02 ? Trust::kCare
                      : Trust::kGood});
  const bool steady = std::ranges::none_of(
      diagnosis.symptoms, [](const Symptom& s) { return s.trust != Trust::kGood; });
  const bool hopeless = std::ranges::any_of(
      diagnosis.symptoms, [](const Symptom& s) { return s.trust == Trust::kBad; });
  diagnosis.verdicts = {
      Worth("ratios of rows in one run", !hopeless && floor < 0.05, !hopeless,
            "take more rounds, and see the intervals"),
      Worth("two programs run in turn (compare --paired)", !hopeless && floor < 0.02, !hopeless,
            fmt::format("changes below {:.0f} % may not show", std::ceil(100 * floor))),
      Worth("times of today against times of last week", steady, !hopeless && floor < 0.05,
            "it may have been another machine then"),
      Worth("absolute times to publish", steady, false, "give ratios, and the machine with them"),
  };
  return diagnosis;
}

}  // namespace definite
