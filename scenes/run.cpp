#include "scenes/run.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>

#include "benchmarks/harness/progress.hpp"

namespace definite::scenes {

namespace {

const CaseResult& ResultOf(const std::vector<CaseResult>& results, const Case& of) {
  return *std::ranges::find(results, of, &CaseResult::of);
}

bool IsWithin(double value, const Criterion& c) { return value >= c.low && value <= c.high; }

// Median, least and greatest; NaN of nothing.
void SetRange(std::vector<double> values, Judgement& judgement) {
  judgement.value = judgement.low = judgement.high = std::nan("");
  if (values.empty()) return;
  std::ranges::sort(values);
  judgement.value = values[values.size() / 2];
  judgement.low = values.front();
  judgement.high = values.back();
}

Judgement Judge(const Criterion& c, const std::vector<CaseResult>& results) {
  Judgement judgement{c, 0, 0, 0, false};
  const CaseResult& result = ResultOf(results, c.of);
  const std::uint64_t starts = result.starts.size();
  switch (c.kind) {
    case Criterion::kFraction: {
      const std::uint64_t count = result.Count(c.figure);
      const Interval interval = WilsonInterval(count, starts);
      judgement.value = static_cast<double>(count) / static_cast<double>(starts);
      judgement.low = interval.low;
      judgement.high = interval.high;
      judgement.holds = IsWithin(judgement.value, c);
      break;
    }
    case Criterion::kMedian:
    case Criterion::kEach: {
      const std::vector<double> values = result.Sorted(c.figure);
      SetRange(values, judgement);
      // A start that ended early has no value, and does not count as within.
      judgement.holds = c.kind == Criterion::kMedian
                            ? 2 * values.size() > starts && IsWithin(judgement.value, c)
                            : values.size() == starts && std::ranges::all_of(values, [&](double v) {
                                return IsWithin(v, c);
                              });
      break;
    }
    case Criterion::kRatio: {
      const CaseResult& beside = ResultOf(results, c.beside);
      std::vector<double> ratios;
      for (std::size_t i = 0; i < starts; ++i) {
        const double ratio = result.starts[i][c.figure] / beside.starts[i][c.figure];
        if (!std::isnan(ratio)) ratios.push_back(ratio);
      }
      SetRange(std::move(ratios), judgement);
      judgement.holds = IsWithin(judgement.value, c);
      break;
    }
    case Criterion::kDiffers:
    case Criterion::kNoMatter: {
      const std::uint64_t count = result.Count(c.figure);
      const CaseResult& beside = ResultOf(results, c.beside);
      const std::uint64_t other = beside.Count(c.figure);
      const Interval difference = DifferenceInterval(other, beside.starts.size(), count, starts);
      judgement.value = FisherTest(count, starts, other, beside.starts.size());
      judgement.low = difference.low;
      judgement.high = difference.high;
      judgement.holds = c.kind == Criterion::kDiffers ? judgement.value < 0.05 && count > other
                                                      : judgement.value >= 0.05;
      break;
    }
  }
  return judgement;
}

void AppendNew(const Case& c, std::vector<Case>& cases) {
  if (std::ranges::find(cases, c) == cases.end()) cases.push_back(c);
}

}  // namespace

std::vector<bool> CaseResult::Event(Figure figure) const {
  std::vector<bool> event;
  for (const Outcome& o : starts) event.push_back(o[figure] > 0);
  return event;
}

std::uint64_t CaseResult::Count(Figure figure) const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(starts, [&](const Outcome& o) { return o[figure] > 0; }));
}

std::vector<double> CaseResult::Sorted(Figure figure) const {
  std::vector<double> values;
  for (const Outcome& o : starts) {
    if (!std::isnan(o[figure])) values.push_back(o[figure]);
  }
  std::ranges::sort(values);
  return values;
}

std::string_view NameOf(Verdict verdict) {
  constexpr std::string_view kNames[] = {"reproduced", "partly", "not"};
  return kNames[static_cast<int>(verdict)];
}

std::string_view NameOf(Ablation::Effect effect) {
  constexpr std::string_view kNames[] = {"no change", "changed", "undecided"};
  return kNames[effect];
}

std::vector<Case> CasesOf(const Scene& scene, const Plan& plan) {
  std::vector<Case> cases;
  const auto wanted = [&](const Case& c) { return !plan.filter || c.filter == *plan.filter; };
  for (const Criterion& c : scene.criteria()) {
    if (wanted(c.of)) AppendNew(c.of, cases);
    if (c.IsPair() && wanted(c.beside)) AppendNew(c.beside, cases);
  }
  return cases;
}

std::optional<std::vector<CaseResult>> RunCases(const Scene& scene, const std::vector<Case>& cases,
                                                const Plan& plan) {
  std::vector<CaseResult> results;
  for (const Case& c : cases) results.push_back({c, std::vector<Outcome>(plan.starts)});
  const auto runs = static_cast<long>(cases.size() * plan.starts);
  std::exception_ptr error;
  std::mutex mutex;
#pragma omp parallel for schedule(dynamic) num_threads(plan.threads)
  for (long run = 0; run < runs; ++run) {
    if (Interrupted()) continue;
    const std::size_t at = static_cast<std::size_t>(run) / plan.starts;
    const std::uint64_t start = static_cast<std::uint64_t>(run) % plan.starts;
    try {
      results[at].starts[start] = scene.run(cases[at], plan.seed, start, nullptr);
    } catch (...) {  // may not leave the loop
      const std::lock_guard lock(mutex);
      error = std::current_exception();
    }
    plan.advance();
  }
  if (error) std::rethrow_exception(error);
  if (Interrupted()) return std::nullopt;
  return results;
}

std::optional<SceneResult> RunScene(const Scene& scene, const Plan& plan) {
  auto results = RunCases(scene, CasesOf(scene, plan), plan);
  if (!results) return std::nullopt;
  SceneResult result{&scene, std::move(*results), {}, {}};
  std::size_t held = 0;
  const auto has = [&](const Case& c) {
    return std::ranges::find(result.cases, c, &CaseResult::of) != result.cases.end();
  };
  const std::vector<Criterion> criteria = scene.criteria();
  for (const Criterion& c : criteria) {
    if (!has(c.of) || (c.IsPair() && !has(c.beside))) continue;
    result.judgements.push_back(Judge(c, result.cases));
    held += result.judgements.back().holds;
  }
  if (result.judgements.size() < criteria.size()) return result;
  result.verdict = held == criteria.size() ? Verdict::kReproduced
                   : held > 0              ? Verdict::kPartly
                                           : Verdict::kNot;
  return result;
}

std::optional<std::vector<Ablation>> Ablate(const Scene& scene, const Plan& plan) {
  const std::vector<Case> contrast = scene.contrast();
  const std::vector<Change> changes = scene.changes();
  std::vector<Case> cases = contrast;
  for (const Change& change : changes) {
    for (Case c : contrast) {
      c.change = change.name;
      cases.push_back(c);
    }
  }
  const auto results = RunCases(scene, cases, plan);
  if (!results) return std::nullopt;
  std::vector<Ablation> ablations;
  for (std::size_t i = contrast.size(); i < cases.size(); ++i) {
    const CaseResult& with = (*results)[i % contrast.size()];
    Ablation a{changes[i / contrast.size() - 1], with, (*results)[i], {}, Ablation::kUndecided};
    a.difference = PairedInterval(with.Event(Figure::kFails), a.without.Event(Figure::kFails));
    if (a.difference.low >= -kSameFraction && a.difference.high <= kSameFraction) {
      a.effect = Ablation::kNoChange;
    } else if (a.difference.low > 0 || a.difference.high < 0) {
      a.effect = Ablation::kChanged;
    }
    ablations.push_back(std::move(a));
  }
  return ablations;
}

std::vector<double> MapMus() { return {0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100}; }

std::vector<std::string> MapFilters() {
  return {"none",      "gauss_newton", "gauss_newton_frame", "analytic",         "split",
          "nearest",   "numeric",      "absolute",           "absolute_numeric", "blend_half",
          "on_demand", "progressive"};
}

std::vector<Case> MapCases(const Scene& scene, const Plan& plan) {
  std::vector<Case> cases;
  for (const std::string& length : scene.lengths()) {
    for (const std::string& filter : MapFilters()) {
      if (plan.filter && filter != *plan.filter) continue;
      for (const double mu : MapMus()) {
        Case c = scene.contrast().front();
        c.length = length;
        c.filter = filter;
        c.mu = mu;
        cases.push_back(c);
      }
    }
  }
  return cases;
}

}  // namespace definite::scenes
