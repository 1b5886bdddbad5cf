#pragma once

// Where a result comes from: the machine and the build.

#include <nlohmann/json.hpp>

namespace definite {

// {"cpu", "cores", "os", "load_average", "noisy"}; noisy says that more processes wanted to run
// than there are cores.
nlohmann::ordered_json DescribeMachine();

// {"compiler", "flags", "type", "isa", "eigen", "libm", "commit"}.
nlohmann::ordered_json DescribeBuild();

// SHA-256 of docs/protocol.md.
std::string ProtocolHash();

}  // namespace definite
