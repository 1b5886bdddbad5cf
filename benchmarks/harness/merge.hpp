#pragma once

// Puts parts of a sweep together: shards, runs that were interrupted, the ranks of an MPI run.

#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "benchmarks/harness/sweep.hpp"

namespace definite {

// Says what does not fit, and where.
class MergeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The statistics of a sweep's result that was written with its histograms; no timing, no worst
// cases. Throws MergeError if it is another program's, or not whole.
SweepResult FromJson(const nlohmann::ordered_json& json);

// All of them as one. What some have in common counts once; it must agree. Order does not matter.
// Throws MergeError if the plans differ, if blocks in common have different outputs, or if two
// parts overlap so that neither they nor others can be put side by side.
SweepResult Merge(std::span<const SweepResult> parts);

// "of 2 energies; collision/... has 512 of 1024 blocks": what was not checked.
std::string DescribeMissing(const SweepResult& result);

// The canonical file (docs/protocol.md, section 6): the same bytes however the sweep was shared
// out.
std::string CanonicalText(const SweepResult& result);

}  // namespace definite
