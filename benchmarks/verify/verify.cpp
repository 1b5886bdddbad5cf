#include "benchmarks/verify/verify.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "benchmarks/harness/sampling/batch.hpp"

namespace definite::verify {

namespace {

// Some configurations of one energy.
struct Block {
  std::size_t energy;
  const Distribution* distribution;
  std::uint64_t first;
  std::int64_t size;
};

std::vector<Block> BlocksOf(const Plan& plan) {
  constexpr std::uint64_t kBlock = 16;
  std::vector<Block> blocks;
  for (std::size_t e = 0; e < plan.subjects.size(); ++e) {
    for (const Distribution* distribution : plan.distributions) {
      if (!distribution->supports(plan.subjects[e].energy->stencil)) continue;
      for (std::uint64_t done = 0; done < plan.count; done += kBlock) {
        blocks.push_back({e, distribution, plan.first + done,
                          static_cast<std::int64_t>(std::min(kBlock, plan.count - done))});
      }
    }
  }
  return blocks;
}

std::vector<EnergyResult> EmptyResults(const Plan& plan) {
  std::vector<EnergyResult> results;
  for (const Subject& subject : plan.subjects) {
    EnergyResult result = {subject, 0, 0, {}};
    for (const Check& check : plan.checks) {
      if (check.applies(subject)) result.checks.push_back({&check, 0, std::nullopt});
    }
    results.push_back(result);
  }
  return results;
}

void ExamineBlock(const Plan& plan, const Block& block, EnergyResult& result) {
  const Subject& subject = result.subject;
  Batch batch(*subject.energy);
  batch.Draw(*block.distribution, plan.seed, block.first, WholeTiles(block.size));
  for (std::int64_t i = 0; i < block.size; ++i) {
    ++result.drawn;
    Case at(subject, batch.X(i), batch.P(i));
    const bool active = at.Active();
    result.active += active;
    const std::uint64_t index = block.first + static_cast<std::uint64_t>(i);
    for (CheckResult& check : result.checks) {
      if (!active && !check.check->everywhere) continue;
      if (const std::optional<Finding> finding = check.check->find(at)) {
        check.Merge({check.check, 1, Worst{*finding, block.distribution, index}});
      }
    }
  }
}

}  // namespace

void CheckResult::Merge(const CheckResult& other) {
  configurations += other.configurations;
  if (!other.worst) return;
  const auto place = [](const Worst& w) { return std::pair(w.distribution->name, w.index); };
  const auto size = [](const Worst& w) {
    return std::isnan(w.finding.violation) ? std::numeric_limits<double>::infinity()
                                           : w.finding.violation;
  };
  if (!worst || size(*other.worst) > size(*worst) ||
      (size(*other.worst) == size(*worst) && place(*other.worst) < place(*worst))) {
    worst = other.worst;
  }
}

Result RunChecks(const Plan& plan, Progress& progress) {
  Result result;
  result.plan = plan;
  if (double load; getloadavg(&load, 1) == 1) result.load_before = load;
  const std::vector<Block> blocks = BlocksOf(result.plan);
  result.energies = EmptyResults(result.plan);

  progress.Start("verify", blocks.size());
  std::atomic<std::size_t> next_block{0};
  std::vector<std::vector<EnergyResult>> parts(static_cast<std::size_t>(plan.threads),
                                               result.energies);
#pragma omp parallel num_threads(plan.threads)
  {
    auto& mine = parts[static_cast<std::size_t>(omp_get_thread_num())];
    // Blocks are handed out in order and always finished.
    while (!Interrupted()) {
      const std::size_t b = next_block++;
      if (b >= blocks.size()) break;
      ExamineBlock(result.plan, blocks[b], mine[blocks[b].energy]);
      progress.Advance(1);
    }
  }
  progress.Finish();
  for (const std::vector<EnergyResult>& part : parts) {
    for (std::size_t e = 0; e < part.size(); ++e) {
      EnergyResult& energy = result.energies[e];
      energy.drawn += part[e].drawn;
      energy.active += part[e].active;
      for (std::size_t c = 0; c < part[e].checks.size(); ++c) {
        energy.checks[c].Merge(part[e].checks[c]);
      }
    }
  }
  result.partial = Interrupted();
  return result;
}

}  // namespace definite::verify
