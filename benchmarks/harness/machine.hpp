#pragma once

// Where a result comes from: the machine and the build.

#include <nlohmann/json.hpp>
#include <optional>

namespace definite {

// {"cpu", "cores", "os", "load_average", "noisy"}: the load before the run, and whether other work
// disturbed it.
nlohmann::ordered_json DescribeMachine(const std::optional<double>& load, bool noisy);

// {"compiler", "flags", "type", "isa", "eigen", "libm", "commit"}.
nlohmann::ordered_json DescribeBuild();

// SHA-256 of docs/protocol.md.
std::string ProtocolHash();

}  // namespace definite
