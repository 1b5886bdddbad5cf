#include "scenes/predict.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "benchmarks/harness/progress.hpp"

namespace definite::scenes {

namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

constexpr std::size_t kMostContacts = 500;  // evenly out of all that are met
constexpr std::uint64_t kMostStarts = 8;
// What is less is rounding, whose ranks would say nothing; where that is all, filters are alike.
constexpr double kLeastError = 1e-9;

struct Met {
  std::string energy;
  std::vector<double> x, p;  // 12 and 3 numbers for each
  std::size_t Size() const { return x.size() / 12; }
};

Met ContactsMet(const Scene& scene, Case c, const Plan& plan) {
  c.filter = "analytic";
  Recorder recorder;
  for (std::uint64_t start = 0; start < std::min(plan.starts, kMostStarts); ++start) {
    scene.run(c, plan.seed, start, &recorder);
  }
  const Contacts contacts = scene.make(c, plan.seed, 0).model.contacts;
  const std::size_t all = recorder.side.size();
  const std::size_t every = std::max<std::size_t>(1, (all + kMostContacts - 1) / kMostContacts);
  Met met{contacts.Energy(), {}, {}};
  for (std::size_t i = 0; i < all; i += every) {
    met.x.insert(met.x.end(), &recorder.x[12 * i], &recorder.x[12 * i] + 12);
    for (const double p : {contacts.k, contacts.eps, recorder.side[i]}) met.p.push_back(p);
  }
  return met;
}

Matrix12 FilteredAt(const KernelRow& row, const Met& met, std::size_t i) {
  double packed[78];
  row.run(&met.x[12 * i], &met.p[3 * i], packed, 1);
  Matrix12 f;
  const double* entry = packed;
  for (int r = 0; r < 12; ++r) {
    for (int c = r; c < 12; ++c) f(r, c) = f(c, r) = *entry++;
  }
  return f;
}

// inertia: m/dt^2 of each coordinate.
Errors ErrorsOf(const KernelRow& row, const Met& met, double inertia) {
  const KernelRow& nearest = KernelOf(met.energy, "nearest");
  std::vector<double> distances, step_errors;
  for (std::size_t i = 0; i < met.Size(); ++i) {
    const Matrix12 f = FilteredAt(row, met, i), p = FilteredAt(nearest, met, i);
    if (p.norm() == 0) continue;
    Vector12 gradient;
    row.energy->gradient(&met.x[12 * i], &met.p[3 * i], gradient.data(), 1);
    const auto step = [&](const Matrix12& h) -> Vector12 {
      return (inertia * Matrix12::Identity() + h).partialPivLu().solve(gradient);
    };
    const Vector12 best = step(p);
    distances.push_back((f - p).norm() / p.norm());
    if (best.norm() > 0) step_errors.push_back((step(f) - best).norm() / best.norm());
  }
  const auto median = [](const std::vector<double>& errors) {
    const double middle = MedianOf(errors);
    return middle < kLeastError ? 0 : middle;
  };
  return {distances.size(), median(distances), median(step_errors)};
}

// Ranks from 0; those of equal values are their mean.
std::vector<double> RanksOf(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, end; first < order.size(); first = end) {
    end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) {
      ranks[order[i]] = static_cast<double>(first + end - 1) / 2;
    }
  }
  return ranks;
}

}  // namespace

std::optional<std::vector<std::optional<Errors>>> ErrorsOf(const Scene& scene,
                                                           const std::vector<CaseResult>& map,
                                                           const Plan& plan) {
  std::map<std::pair<std::string, double>, Met> met;
  std::vector<std::optional<Errors>> errors;
  for (const CaseResult& cell : map) {
    if (Interrupted()) return std::nullopt;
    const Case& c = cell.of;
    const auto [at, is_new] = met.try_emplace({c.length, c.mu});
    if (is_new) at->second = ContactsMet(scene, c, plan);
    const KernelRow* row = FindKernel(at->second.energy + "/" + c.filter + "/f64");
    if (!row || at->second.Size() == 0) {
      errors.emplace_back();
      continue;
    }
    const double k = at->second.p[0];
    errors.push_back(ErrorsOf(*row, at->second, k / c.mu));  // mu = dt^2 k / m
  }
  return errors;
}

double RankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = RanksOf(a), y = RanksOf(b);
  const double middle = (static_cast<double>(a.size()) - 1) / 2;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - middle) * (x[i] - middle);
    xy += (x[i] - middle) * (y[i] - middle);
    yy += (y[i] - middle) * (y[i] - middle);
  }
  return xy / std::sqrt(xx * yy);
}

Prediction PredictionOf(const std::vector<CaseResult>& map,
                        std::span<const std::optional<Errors>> errors) {
  struct Group {
    std::vector<double> fails, distance, step_error;
  };
  std::map<std::pair<std::string, double>, Group> groups;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!errors[i]) continue;
    Group& group = groups[{map[i].of.length, map[i].of.mu}];
    group.fails.push_back(static_cast<double>(map[i].Count(Figure::kFails)));
    group.distance.push_back(errors[i]->distance);
    group.step_error.push_back(errors[i]->step_error);
  }
  Prediction prediction;
  for (const auto& [name, group] : groups) {
    const double distance = RankCorrelation(group.fails, group.distance);
    const double step = RankCorrelation(group.fails, group.step_error);
    if (std::isnan(distance) || std::isnan(step)) continue;
    ++prediction.groups;
    prediction.distance += distance;
    prediction.step_error += step;
  }
  if (prediction.groups > 0) {
    prediction.distance /= prediction.groups;
    prediction.step_error /= prediction.groups;
  }
  return prediction;
}

}  // namespace definite::scenes
