#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/plans/markdown.hpp"
#include "benchmarks/plans/plan.hpp"
#include "benchmarks/plans/result.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

using definite::Show;  // beside those of this file

constexpr std::string_view kDistribution = "paper";

// Table 1: seconds for 10^7 random arrangements.
struct PublishedRow {
  std::string label, energy;
  double numeric, analytic, gauss_newton;
};
const std::array<PublishedRow, 5> kTable1 = {{
    {"vertex-face signed", "collision/vertex_face/signed/quadratic", 88.48, 12.31, 11.12},
    {"vertex-face unsigned", "collision/vertex_face/unsigned/quadratic", 83.68, 18.55, 10.93},
    {"edge-edge signed", "collision/edge_edge/signed/quadratic", 84.30, 13.01, 12.04},
    {"edge-edge unsigned", "collision/edge_edge/unsigned_frozen/quadratic", 86.45, 11.98, 8.78},
    {"edge-edge hybrid", "collision/edge_edge/hybrid/quadratic", 85.16, 13.52, 12.29},
}};

// The filters of the tables: row name after the energy, and how it reads.
const std::vector<std::pair<std::string, std::string>> kFilters = {
    {"numeric/f64", "numeric 12x12"},
    {"numeric_frame/f64", "numeric 9x9"},
    {"analytic_frame/f64", "analytic, through the frame"},
    {"analytic/f64", "analytic, stable"},
    {"analytic/f64x8", "analytic, 8 lanes"},
    {"gauss_newton_frame/f64", "G-N, through the frame"},
    {"gauss_newton/f64", "G-N, outer product"},
    {"gauss_newton/f64x8", "G-N, 8 lanes"},
};

// The exact Hessian of the clamped distance, which the paper does not have: its table shows only
// how it differs.
const std::string kEnvelope = "collision/edge_edge/unsigned/quadratic";
const std::vector<std::pair<std::string, std::string>> kEnvelopeFilters = {
    {"numeric/f64", "numeric 12x12"},
    {"analytic/f64", "analytic, stable"},
    {"analytic/f64x8", "analytic, 8 lanes"},
    {"gauss_newton/f64", "G-N, outer product"},
};

const Json& RowOf(const Json& result, const std::string& energy, const std::string& filter) {
  const std::string name = energy + "/" + filter;
  for (const Json& row : result.at("rows")) {
    if (row.at("kernel") == name && row.at("distribution") == kDistribution) return row;
  }
  throw std::runtime_error("the result lacks the row " + name);
}

struct Interval {
  double median, low, high;
};

std::optional<Interval> IntervalOf(const Json& estimate) {
  if (estimate.is_null()) return std::nullopt;
  return Interval{estimate.at("median"), estimate.at("low"), estimate.at("high")};
}

// The timing over "all" pairs or the "active" ones; null if there is none.
Json TimingOf(const Json& row, const std::string& pairs) {
  for (const Json& timing : row.at("timing")) {
    if (timing.at("pairs") == pairs) return timing;
  }
  return nullptr;
}

// Nanoseconds of one core: several threads share the wall time.
std::optional<Interval> NsOf(const Json& row, const std::string& pairs = "all") {
  const Json timing = TimingOf(row, pairs);
  if (timing.is_null()) return std::nullopt;
  auto ns = IntervalOf(timing.at("ns_per_hessian"));
  const int threads = timing.at("threads");
  if (ns) *ns = {ns->median * threads, ns->low * threads, ns->high * threads};
  return ns;
}

// time of `baseline` / time of the row.
std::optional<Interval> RatioTo(const Json& row, const std::string& baseline,
                                const std::string& pairs = "all") {
  const Json timing = TimingOf(row, pairs);
  return timing.is_null() ? std::nullopt : IntervalOf(timing.at("ratio_to").at(baseline));
}

std::optional<Interval> Inverse(const std::optional<Interval>& r) {
  if (!r) return r;
  return Interval{1 / r->median, 1 / r->high, 1 / r->low};
}

std::string Show(const std::optional<Interval>& r, const char* format) {
  return r ? fmt::format(fmt::runtime(format), r->median) : "-";
}
std::string ShowInterval(const std::optional<Interval>& r) {
  return r ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", r->median, r->low, r->high) : "not timed";
}

// An interrupted run lacks some figures, one without timing all times.
Json NotMeasured(const std::string& claim, const std::string& theirs) {
  return Claim(claim, theirs, "not measured", "not reproduced", "not measured in this run");
}

Json SpeedClaim(const Json& result, const PublishedRow& published) {
  const double theirs = published.numeric / published.analytic;
  const auto paper_form = RatioTo(RowOf(result, published.energy, "analytic_frame/f64"), "numeric");
  const auto stable = RatioTo(RowOf(result, published.energy, "analytic/f64"), "numeric");
  const std::string claim =
      fmt::format("{}: analytic is {:.2f} times faster than numeric", published.label, theirs);
  const std::string published_ratio = fmt::format("{:.2f}", theirs);
  if (!paper_form || !stable) return NotMeasured(claim, published_ratio);
  std::string verdict = "not reproduced";
  std::string reason = "the analytic form is faster than the eigendecomposition, but by less";
  if (paper_form->high >= theirs) {
    verdict = "reproduced";
    reason = "through the 12x9 and 9x9 products of the reduced frame";
  } else if (stable->low >= theirs) {
    verdict = "qualified";
    reason = "less through the frame's products, more as three outer products in x-space";
  }
  return Claim(claim, published_ratio, ShowInterval(paper_form), verdict, reason);
}

// How much of a ratio may be due to another machine.
constexpr double kTolerance = 1.05;

Json OverheadClaim(const Json& result, const PublishedRow& published) {
  const double theirs = published.analytic / published.gauss_newton;
  const auto frame =
      Inverse(RatioTo(RowOf(result, published.energy, "analytic_frame/f64"), "gauss_newton_frame"));
  const auto outer =
      Inverse(RatioTo(RowOf(result, published.energy, "analytic_frame/f64"), "gauss_newton"));
  const std::string claim = fmt::format("{}: analytic costs {:.0f} % more than Gauss-Newton",
                                        published.label, 100 * (theirs - 1));
  if (!frame || !outer) return NotMeasured(claim, fmt::format("{:.2f}", theirs));
  const bool holds = frame->low <= theirs * kTolerance;
  return Claim(
      claim, fmt::format("{:.2f}", theirs), ShowInterval(frame),
      holds ? "qualified" : "not reproduced",
      fmt::format("{} if Gauss-Newton goes through the same 12x9 and 9x9 products; against the "
                  "single outer product that it is, {:.1f} times its cost",
                  holds ? "holds" : "more even", outer->median));
}

Json PsdClaim(const Json& result) {
  double worst = 0;
  std::uint64_t non_psd = 0, checked = 0;
  for (const PublishedRow& published : kTable1) {
    const Json& row = RowOf(result, published.energy, "analytic/f64");
    worst = std::max(worst, Entry(row, "psd_defect", "max").value_or(0));
    non_psd += row.at("verdicts").at("non_psd").get<std::uint64_t>() +
               row.at("verdicts").at("non_finite").get<std::uint64_t>();
    checked += row.at("active").get<std::uint64_t>();
  }
  const std::string claim = "the filtered Hessian is positive semidefinite";
  if (checked == 0) return NotMeasured(claim, "always");
  return Claim(claim, "always",
               fmt::format("{} of {} not", WithCommas(non_psd), WithCommas(checked)),
               non_psd == 0 ? "reproduced" : "not reproduced",
               fmt::format("worst -lambda_min/(n u |F|) is {:.2g}; 50 is the bound", worst));
}

// Pinning the negative eigenvalues of the frame is not the nearest PSD matrix of the Hessian.
Json ProjectionClaim(const Json& result) {
  const std::string claim = "clamping in the reduced frame stands in for the numerical projection";
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::vector<std::string> farther;
  for (const PublishedRow& published : kTable1) {
    const auto median = [&](const std::string& filter) {
      return Entry(RowOf(result, published.energy, filter), "distance", "median");
    };
    const auto analytic = median("analytic/f64"), gauss_newton = median("gauss_newton/f64");
    if (!analytic || !gauss_newton) return NotMeasured(claim, "implied");
    least = std::min(least, *analytic);
    most = std::max(most, *analytic);
    if (*analytic > *gauss_newton) farther.push_back(published.label);
  }
  const std::string ours = fmt::format("distance to it, medians {:.2g} to {:.2g}", least, most);
  constexpr double kSame = 1e-10;
  if (most <= kSame) return Claim(claim, "implied", ours, "reproduced", "the two agree");
  const std::string reason =
      "it equals the clamp of the 9x9 frame; the nearest PSD matrix of the 12x12 Hessian is "
      "another one, since the frame map is not orthogonal";
  if (farther.empty()) return Claim(claim, "implied", ours, "qualified", reason);
  return Claim(claim, "implied", ours, "not reproduced",
               fmt::format("{}; farther from it than Gauss-Newton for {}", reason,
                           fmt::join(farther, ", ")));
}

// With the weights held constant the filter is a sign test.
Json FrozenClaim(const Json& result) {
  const std::string claim =
      "edge-edge unsigned: the negative eigenvalues are filtered in closed form";
  const auto median = Entry(RowOf(result, kTable1[3].energy, "analytic/f64"), "distance", "median");
  const auto exact = Entry(RowOf(result, kEnvelope, "analytic/f64"), "distance", "median");
  if (!median || !exact) return NotMeasured(claim, "Eq. 53");
  const bool holds = *median <= 1e-10;
  return Claim(
      claim, "Eq. 53", fmt::format("median distance to nearest {:.1e}", *median),
      holds ? "qualified" : "not reproduced",
      fmt::format("{} the nearest PSD matrix of the Hessian that Eq. 53 gives, which holds the "
                  "weights constant, and outside contact Gauss-Newton, identically; of the exact "
                  "Hessian of the distance the same clamp misses it by {:.2g} in the median",
                  holds ? "it is" : "it is not", *exact));
}

// Of the configurations: those that numeric was timed on.
std::string TimedShareOf(const Json& result, const std::string& pairs) {
  const Json timing = TimingOf(RowOf(result, kTable1[0].energy, "numeric/f64"), pairs);
  return timing.is_null() ? "none" : Percent(timing.at("share")) + " %";
}

// Seconds for 10^7 of "all" pairs or of the "active" ones.
std::string Table1(const Json& result, const std::string& pairs) {
  const auto seconds = [&](const PublishedRow& p, const std::string& filter) {
    const auto ns = NsOf(RowOf(result, p.energy, filter), pairs);
    return ns ? fmt::format("{:.2f}", ns->median * 1e-9 * 1e7) : "-";
  };
  std::vector<std::vector<std::string>> table = {
      {"", "numeric", "analytic", "G-N", "ratio", "numeric", "analytic", "G-N", "ratio"}};
  for (const PublishedRow& p : kTable1) {
    table.push_back(
        {p.label, fmt::format("{:.2f}", p.numeric), fmt::format("{:.2f}", p.analytic),
         fmt::format("{:.2f}", p.gauss_newton), fmt::format("{:.2f}", p.numeric / p.analytic),
         seconds(p, "numeric/f64"), seconds(p, "analytic_frame/f64"),
         seconds(p, "gauss_newton_frame/f64"),
         Show(RatioTo(RowOf(result, p.energy, "analytic_frame/f64"), "numeric", pairs), "{:.2f}")});
  }
  const Json& first = result.at("rows").at(0);
  const Json timing = TimingOf(first, pairs);
  if (pairs == "active") {
    return "\n### Table 1 over active pairs: seconds for 10^7 Hessians\n\n" + MarkdownTable(table) +
           Paragraph("The same run, those pairs alone where the energy acts (l < eps).");
  }
  return "### Table 1: seconds for 10^7 Hessians\n\n" + MarkdownTable(table) +
         Paragraph(fmt::format(
             "Theirs on the left, ours on the right, analytic and Gauss-Newton (G-N) through the "
             "12x9 and 9x9 products of the reduced frame. Time of one core, {}, over {} "
             "configurations of `{}`, seed {}; numeric on {} of them, spread evenly.",
             timing.is_null() ? "not measured"
             : timing.at("clock") == "wall"
                 ? fmt::format("from wall time on {} threads", timing.at("threads").get<int>())
                 : "CPU time of one thread",
             WithCommas(first.at("count").get<std::uint64_t>()), kDistribution,
             result.at("seed").get<std::uint64_t>(), TimedShareOf(result, pairs)));
}

std::string Forms(const Json& result) {
  std::vector<std::vector<std::string>> table = {
      {"numeric / analytic", "paper", "frame", "stable", "8 lanes", "active %"}};
  for (const PublishedRow& p : kTable1) {
    const auto ratio = [&](const std::string& filter) {
      return Show(RatioTo(RowOf(result, p.energy, filter), "numeric"), "{:.1f}");
    };
    table.push_back({p.label, fmt::format("{:.1f}", p.numeric / p.analytic),
                     ratio("analytic_frame/f64"), ratio("analytic/f64"), ratio("analytic/f64x8"),
                     Percent(RowOf(result, p.energy, "analytic/f64").at("active_fraction"))});
  }
  std::string text = "\n### What it depends on: the same filters in other forms\n\n";
  text += MarkdownTable(table) + "\n";
  table = {{"analytic / G-N", "paper", "frame/frame", "frame/outer", "stable/outer", "+ns frame",
            "+ns stable"}};
  for (const PublishedRow& p : kTable1) {
    const auto over = [&](const std::string& filter, const std::string& baseline) {
      return Show(Inverse(RatioTo(RowOf(result, p.energy, filter), baseline)), "{:.2f}");
    };
    const auto increment = [&](const std::string& filter, const std::string& baseline) {
      const auto a = NsOf(RowOf(result, p.energy, filter));
      const auto b = NsOf(RowOf(result, p.energy, baseline));
      return a && b ? fmt::format("{:.0f}", a->median - b->median) : "-";
    };
    table.push_back({p.label, fmt::format("{:.2f}", p.analytic / p.gauss_newton),
                     over("analytic_frame/f64", "gauss_newton_frame"),
                     over("analytic_frame/f64", "gauss_newton"),
                     over("analytic/f64", "gauss_newton"),
                     increment("analytic_frame/f64", "gauss_newton_frame/f64"),
                     increment("analytic/f64", "gauss_newton/f64")});
  }
  return text + MarkdownTable(table) +
         Paragraph(
             "frame: 12x9 and 9x9 products in Eigen; outer: one outer product of a "
             "12-vector; stable: modes summed in x, scalar; 8 lanes: eight pairs at a time. "
             "+ns: what the filter adds to Gauss-Newton in the same form, on one core.");
}

std::string Accuracy(const Json& result) {
  std::vector<std::pair<std::string, std::string>> energies;
  for (const PublishedRow& p : kTable1) energies.emplace_back(p.label, p.energy);
  energies[3].first += ", weights held constant";
  energies.emplace_back("edge-edge unsigned, exact Hessian", kEnvelope);
  std::string text = "\n### Speed beside accuracy\n";
  for (const auto& [label, energy] : energies) {
    std::vector<std::vector<std::string>> table = {
        {"filter", "ns", "median", "p99", "max", "excess", "defect", "relabel."}};
    for (const auto& [filter, name] : energy == kEnvelope ? kEnvelopeFilters : kFilters) {
      const Json& row = RowOf(result, energy, filter);
      const auto excess = Entry(row, "excess", "median");
      const auto ns = NsOf(row);
      table.push_back({name, Show(ns, ns && ns->median < 100 ? "{:.1f}" : "{:.0f}"),
                       Show(Entry(row, "distance", "median"), "{:.1e}"),
                       Show(Entry(row, "distance", "p99"), "{:.1e}"),
                       Show(Entry(row, "distance", "max"), "{:.1e}"),
                       Show(excess, excess > 1000 ? "{:.0e}" : "{:.2f}"),
                       Show(Entry(row, "psd_defect", "max"), "{:.2g}"),
                       Show(Entry(row, "relabelling", "median"), "{:.1e}")});
    }
    text += "\n" + label + "\n\n" + MarkdownTable(table);
  }
  return text +
         Paragraph(
             "ns: time of one core. Median, p99, max: distance to the nearest PSD matrix of "
             "the row's own Hessian. excess: how much more the filter changes it than it "
             "must, median; vast where that Hessian is PSD already. defect: the worst "
             "-lambda_min/(n u |F|), 50 is the bound. relabel.: how much the result depends "
             "on the numbering of the vertices, median. The numeric rows are looked at on a sample "
             "(docs/protocol.md); the JSON has each figure's count.");
}

std::string Claims(const Json& claims) {
  std::string text = "\n### Claims\n\n";
  for (const Json& claim : claims) {
    text += Wrapped(
        fmt::format("- **{}**: {}. Paper: {}; here: {}; {}.",
                    claim.at("verdict").get<std::string>(), claim.at("claim").get<std::string>(),
                    claim.at("theirs").get<std::string>(), claim.at("ours").get<std::string>(),
                    claim.at("reason").get<std::string>()),
        98, "  ");
  }
  return text;
}

std::vector<PlannedSweep> Sweeps() {
  std::vector<std::string> rows;
  for (const PublishedRow& published : kTable1) {
    for (const auto& [filter, label] : kFilters) rows.push_back(published.energy + "/" + filter);
  }
  for (const auto& [filter, label] : kEnvelopeFilters) {
    rows.push_back(kEnvelope + "/" + filter);
  }
  return {{rows, kDistribution, {}}};
}

Json AllClaims(const Json& result) {
  Json claims = Json::array();
  for (const PublishedRow& p : kTable1) claims.push_back(SpeedClaim(result, p));
  for (const PublishedRow& p : kTable1) claims.push_back(OverheadClaim(result, p));
  claims.push_back(PsdClaim(result));
  claims.push_back(ProjectionClaim(result));
  claims.push_back(FrozenClaim(result));
  return claims;
}

std::string Markdown(const Json& result) {
  return Table1(result, "all") + Table1(result, "active") + Forms(result) + Accuracy(result) +
         Claims(result.at("claims")) + Provenance(result);
}

}  // namespace

Plan ShiKim2023() {
  return {"shi-kim-2023",
          "Table 1 and the claims of Shi & Kim 2023",
          "1e7",
          true,
          false,
          Detail::kSummaries,
          {.definition = 200'000},  // a double definition takes 60 us
          Sweeps,
          AllClaims,
          Markdown};
}

}  // namespace definite
