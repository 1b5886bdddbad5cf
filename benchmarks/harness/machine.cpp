#include "benchmarks/harness/machine.hpp"

#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <fstream>
#include <string>
#include <thread>

#include "benchmarks/harness/build_info.hpp"
#include "kernels/core/lanes.hpp"

namespace definite {

namespace {

std::string CpuName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "";
}

}  // namespace

nlohmann::ordered_json DescribeMachine(const std::optional<double>& load, bool noisy) {
  const std::string cpu = CpuName();
  const unsigned cores = std::thread::hardware_concurrency();
  utsname system{};
  uname(&system);
  nlohmann::ordered_json machine;
  machine["cpu"] = cpu.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(cpu);
  machine["cores"] = cores;
  machine["os"] = std::string(system.sysname) + " " + system.release + " " + system.machine;
  machine["load_average"] = load ? nlohmann::ordered_json(*load) : nlohmann::ordered_json();
  machine["noisy"] = noisy;
  return machine;
}

nlohmann::ordered_json DescribeBuild() {
  nlohmann::ordered_json build;
  build["compiler"] = build_info::kCompiler;
  build["flags"] = build_info::kFlags;
  build["type"] = build_info::kType;
  build["isa"] = kInstructionSet;
  build["eigen"] = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                   "." + std::to_string(EIGEN_MINOR_VERSION);
  build["libm"] = std::string("glibc ") + gnu_get_libc_version();
  build["commit"] = build_info::kCommit;
  return build;
}

std::string ProtocolHash() { return build_info::kProtocol; }

}  // namespace definite
