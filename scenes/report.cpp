#include "scenes/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

namespace definite::scenes {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN and no infinity.
Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json ToJson(const Case& c) {
  return {{"length", c.length}, {"filter", c.filter},     {"mu", c.mu},
          {"level", c.level},   {"substeps", c.substeps}, {"change", c.change}};
}

Json ToJson(const CaseResult& result, Figure figure) {
  if (InfoOf(figure).is_event) {
    const std::uint64_t count = result.Count(figure), of = result.starts.size();
    const Interval interval = WilsonInterval(count, of);
    return {{"count", count}, {"of", of}, {"low", interval.low}, {"high", interval.high}};
  }
  const std::vector<double> sorted = result.Sorted(figure);
  return {{"median", NumberOrNull(sorted[sorted.size() / 2])},
          {"min", NumberOrNull(sorted.front())},
          {"max", NumberOrNull(sorted.back())},
          {"of", sorted.size()}};
}

// All figures, or events alone.
Json ToJson(const CaseResult& result, bool events_alone = false) {
  Json figures;
  for (std::size_t i = 0; i < kFigures; ++i) {
    const auto figure = static_cast<Figure>(i);
    if (events_alone && !InfoOf(figure).is_event) continue;
    figures[std::string(InfoOf(figure).name)] =
        result.Sorted(figure).empty() ? Json() : ToJson(result, figure);
  }
  return {{"case", ToJson(result.of)}, {"figures", figures}};
}

Json ParametersOf(const Trial& trial) {
  const Model& model = trial.model;
  const auto free = std::ranges::find(model.scripted, false) - model.scripted.begin();
  Json energies = Json::object();
  for (const Elements& term : model.elastic) {
    std::size_t at = 0;
    for (const Parameter& p : KernelOf(term.energy, "none").energy->parameters) {
      energies[term.energy][std::string(p.name)] = term.p[at++];
    }
  }
  return {{"k_newton_per_metre", model.contacts.k},
          {"eps_metre", model.contacts.eps},
          {"dt_second", trial.Dt()},
          {"rayleigh_second", trial.method.rayleigh},
          {"mass_kilogram", model.mass[static_cast<std::size_t>(free)]},
          {"frames", trial.frames},
          {"energies", energies}};
}

constexpr std::string_view kKinds[] = {"fraction", "median", "each",
                                       "differs",  "ratio",  "no_matter"};
// Whether two cases are told apart by a p value, without bounds.
bool IsTest(const Criterion& c) {
  return c.kind == Criterion::kDiffers || c.kind == Criterion::kNoMatter;
}

Json ToJson(const Judgement& j) {
  const Criterion& c = j.criterion;
  return {{"kind", kKinds[c.kind]},
          {"figure", InfoOf(c.figure).name},
          {"case", ToJson(c.of)},
          {"beside", c.IsPair() ? ToJson(c.beside) : Json()},
          {"least", IsTest(c) ? Json() : NumberOrNull(c.low)},
          {"most", IsTest(c) ? Json() : NumberOrNull(c.high)},
          {"value", NumberOrNull(j.value)},
          {"low", NumberOrNull(j.low)},
          {"high", NumberOrNull(j.high)},
          {"holds", j.holds}};
}

Case CaseFrom(const Json& json) {
  return {json.at("length"),   json.at("filter"), json.at("mu"),
          json.at("substeps"), json.at("level"),  json.at("change")};
}

// In lines of at most 100 columns, those after the first indented.
std::string Wrapped(std::string_view text, std::size_t indent) {
  constexpr std::size_t kColumns = 96;  // and what stands before the first
  std::string lines;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (column > 0 && column + 1 + end > kColumns) {
      lines += fmt::format("\n{:<{}}", "", indent);
      column = indent;
    } else if (column > 0) {
      lines += ' ';
      ++column;
    }
    lines += text.substr(0, end);
    column += end;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines + "\n";
}

// A number in a few digits.
std::string Short(double value) {
  if (std::isnan(value)) return "-";
  return fmt::format("{:.3g}", value);
}
std::string Short(const Json& value) { return value.is_null() ? "-" : Short(value.get<double>()); }

std::string Describe(const Judgement& j) {
  const Criterion& c = j.criterion;
  const std::string_view figure = InfoOf(c.figure).name;
  switch (c.kind) {
    case Criterion::kFraction:
      return fmt::format("{} in {:g} to {:g} %", figure, 100 * c.low, 100 * c.high);
    case Criterion::kMedian:
      return fmt::format("median {} in [{:g}, {:g}]", figure, c.low, c.high);
    case Criterion::kEach:
      return fmt::format("every {} in [{:g}, {:g}]", figure, c.low, c.high);
    case Criterion::kRatio:
      return fmt::format("{} over that of {} in [{:g}, {:g}]", figure, c.beside.Label(), c.low,
                         c.high);
    case Criterion::kDiffers:
      return fmt::format("{} more than {}", figure, c.beside.Label());
    case Criterion::kNoMatter:
      return fmt::format("{} as {}", figure, c.beside.Label());
  }
  return {};
}

std::string Measured(const Judgement& j) {
  if (j.criterion.kind == Criterion::kFraction) {
    return fmt::format("{:.3g} % [{:.3g}, {:.3g}]", 100 * j.value, 100 * j.low, 100 * j.high);
  }
  if (IsTest(j.criterion))
    return fmt::format("p={:.2g} [{:+.2f}, {:+.2f}]", j.value, j.low, j.high);
  return fmt::format("{} [{}, {}]", Short(j.value), Short(j.low), Short(j.high));
}

// Tenths of the runs, X from 95 % on, + below a tenth, . for none.
char Cell(std::uint64_t count, std::uint64_t of) {
  if (count == 0) return '.';
  if (20 * count >= 19 * of) return 'X';
  if (10 * count < of) return '+';
  return static_cast<char>('0' + 10 * count / of);
}

std::string MapTable(const std::vector<CaseResult>& map) {
  std::string table = fmt::format("{:<34}", "failing, tenths of starts; mu");
  for (const double mu : MapMus()) table += fmt::format("{:>5g}", mu);
  table += "    time\n";
  std::vector<double> shares, steps;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const bool begins = i % MapMus().size() == 0;
    if (begins) table += fmt::format("{:<15} {:<18}", map[i].of.length, map[i].of.filter);
    const std::string cell(1, Cell(map[i].Count(Figure::kFails), map[i].starts.size()));
    table += fmt::format("{:>5}", cell);
    for (const Outcome& o : map[i].starts) {
      shares.push_back(o.kernel_share);
      steps.push_back(o.step_seconds);
    }
    if ((i + 1) % MapMus().size() == 0) {
      table +=
          fmt::format("{:>8.0f} us{:>3.0f} %\n", 1e6 * MedianOf(steps), 100 * MedianOf(shares));
      shares.clear();
      steps.clear();
    }
  }
  return table +
         "X from 95 % on, + below 10 %, . none; time: of a step, and the share of the kernels in "
         "it\n";
}

}  // namespace

std::string ToTable(const Reported& reported) {
  const Scene& scene = *reported.scene;
  std::string table = Wrapped(fmt::format("{}: {}", scene.name, scene.claim), 2);
  if (reported.result && !reported.result->judgements.empty()) {
    std::size_t held = 0;
    for (const Judgement& j : reported.result->judgements) {
      held += j.holds;
      // In one line where it fits.
      const std::string label = j.criterion.of.Label(), what = Describe(j), value = Measured(j);
      const bool fits = label.size() <= 42 && what.size() <= 29 && value.size() <= 20;
      table += fmt::format("  {:<3} {:<42}{}{:<29} {}\n", j.holds ? "yes" : "NO", label,
                           fits ? " " : "\n      ", what, value);
    }
    table += fmt::format("  {}: {} of {} criteria hold, {} starts\n",
                         reported.result->verdict ? NameOf(*reported.result->verdict)
                                                  : "no verdict, of some of its criteria",
                         held, reported.result->judgements.size(),
                         reported.result->cases.front().starts.size());
    table += "  " + Wrapped(fmt::format("differs from the paper: {}", scene.differs), 4);
  }
  if (reported.ablations) {
    table += fmt::format("  {:<15}{:<43}{:>5}{:>6} {:<15} {}\n", "change", "case", "before",
                         "after", "difference", "effect");
    for (const Ablation& a : *reported.ablations) {
      const auto percent = [](const CaseResult& r) {
        return 100 * static_cast<double>(r.Count(Figure::kFails)) /
               static_cast<double>(r.starts.size());
      };
      table += fmt::format("  {}{:<14}{:<43}{:>4.0f}%{:>5.0f}% [{:+.2f}, {:+.2f}]  {}\n",
                           a.change.is_removed ? '-' : '+', a.change.name, a.with.of.Label(),
                           percent(a.with), percent(a.without), a.difference.low, a.difference.high,
                           NameOf(a.effect));
    }
  }
  if (reported.map) {
    table += MapTable(*reported.map);
    const Prediction p = PredictionOf(*reported.map, reported.errors);
    table += fmt::format(
        "rank correlation of failing fraction and error over filters, mean of {} lengths and "
        "masses:\n"
        "distance {:.2f}, step error {:.2f}\n",
        p.groups, p.distance, p.step_error);
  }
  return table + "\n";
}

Json ToJson(const Plan& plan, std::size_t all_scenes, const std::vector<Reported>& scenes) {
  Json json = {{"starts", plan.starts},
               {"filter", plan.filter ? Json(*plan.filter) : Json()},
               {"all_scenes", all_scenes},
               {"scenes", Json::array()}};
  for (const Reported& reported : scenes) {
    const Scene& scene = *reported.scene;
    Json one = {{"name", scene.name},
                {"claim", scene.claim},
                {"uses", scene.uses},
                {"differs", scene.differs}};
    const Case first = scene.contrast().front();
    const Trial trial = scene.make(first, plan.seed, 0);
    one["degrees_of_freedom"] = 3 * std::ranges::count(trial.model.scripted, false);
    one["parameters"] = ParametersOf(trial);
    if (reported.result && !reported.result->judgements.empty()) {
      if (reported.result->verdict) one["verdict"] = NameOf(*reported.result->verdict);
      one["criteria"] = Json::array();
      for (const Judgement& j : reported.result->judgements) one["criteria"].push_back(ToJson(j));
      one["cases"] = Json::array();
      for (const CaseResult& c : reported.result->cases) one["cases"].push_back(ToJson(c));
    }
    if (reported.ablations) {
      one["ablations"] = Json::array();
      for (const Ablation& a : *reported.ablations) {
        one["ablations"].push_back({{"change", a.change.name},
                                    {"meaning", a.change.meaning},
                                    {"why", a.change.why},
                                    {"removed", a.change.is_removed},
                                    {"case", ToJson(a.with.of)},
                                    {"before", ToJson(a.with, Figure::kFails)},
                                    {"after", ToJson(a.without, Figure::kFails)},
                                    {"low", a.difference.low},
                                    {"high", a.difference.high},
                                    {"effect", NameOf(a.effect)}});
      }
    }
    if (reported.map) {
      const Prediction p = PredictionOf(*reported.map, reported.errors);
      one["prediction"] = {
          {"groups", p.groups}, {"distance", p.distance}, {"step_error", p.step_error}};
      one["map"] = Json::array();
      for (std::size_t i = 0; i < reported.map->size(); ++i) {
        const CaseResult& c = (*reported.map)[i];
        Json cell = ToJson(c, true);  // maps are large
        std::vector<double> shares, steps;
        for (const Outcome& o : c.starts) {
          shares.push_back(o.kernel_share);
          steps.push_back(o.step_seconds);
        }
        cell["timing"] = {{"ns_per_step", 1e9 * MedianOf(steps)},
                          {"kernel_share", MedianOf(shares)}};
        if (const auto& errors = reported.errors[i]) {
          cell["error"] = {{"contacts", errors->contacts},
                           {"distance", errors->distance},
                           {"step_error", errors->step_error}};
        }
        one["map"].push_back(cell);
      }
    }
    json["scenes"].push_back(one);
  }
  return json;
}

std::string ToMarkdown(const Json& result) {
  const Json& scenes = result.at("scenes");
  std::string text =
      fmt::format("# Scenes\n\n## Verdicts\n\nSeed {}, {} starts.\n\n",
                  result.at("seed").get<std::uint64_t>(), scenes.at("starts").get<std::uint64_t>());
  text +=
      "| scene | degrees of freedom | claim | verdict | criteria that hold "
      "|\n|---|--:|---|---|--:|\n";
  for (const Json& s : scenes.at("scenes")) {
    if (!s.contains("verdict")) continue;
    const auto held = std::ranges::count_if(
        s.at("criteria"), [](const Json& c) { return c.at("holds").get<bool>(); });
    text += fmt::format("| `{}` | {} | {} | {} | {} of {} |\n", s.at("name").get<std::string>(),
                        s.at("degrees_of_freedom").get<int>(), s.at("claim").get<std::string>(),
                        s.at("verdict").get<std::string>(), held, s.at("criteria").size());
  }
  for (const Json& s : scenes.at("scenes")) {
    if (!s.contains("verdict")) continue;
    text += fmt::format("\n## Criteria of {}\n\n", s.at("name").get<std::string>());
    text +=
        "| case | what | expected | measured | 95 % interval, or range | holds |\n"
        "|---|---|---|--:|---|---|\n";
    for (const Json& c : s.at("criteria")) {
      const std::string kind = c.at("kind");
      std::string expected;
      if (kind == "differs") {
        expected = "more than " + CaseFrom(c.at("beside")).Label() + ", p < 0.05";
      } else if (kind == "no_matter") {
        expected = "as " + CaseFrom(c.at("beside")).Label() + ", p >= 0.05";
      } else if (kind == "ratio") {
        expected = fmt::format("{} to {} times that of {}", Short(c.at("least")),
                               Short(c.at("most")), CaseFrom(c.at("beside")).Label());
      } else {
        expected = fmt::format("{} to {}", Short(c.at("least")), Short(c.at("most")));
      }
      text += fmt::format("| {} | {}, {} | {} | {} | {} to {} | {} |\n",
                          CaseFrom(c.at("case")).Label(), c.at("figure").get<std::string>(), kind,
                          expected, Short(c.at("value")), Short(c.at("low")), Short(c.at("high")),
                          c.at("holds").get<bool>() ? "yes" : "**no**");
    }
  }
  for (const Json& s : scenes.at("scenes")) {
    if (!s.contains("ablations")) continue;
    text += fmt::format("\n## Ablation of {}\n\n", s.at("name").get<std::string>());
    text +=
        "| change | why | case | failing before | after | interval of the difference | effect |\n"
        "|---|---|---|--:|--:|---|---|\n";
    for (const Json& a : s.at("ablations")) {
      const auto fraction = [](const Json& f) {
        return fmt::format("{}/{}", f.at("count").get<int>(), f.at("of").get<int>());
      };
      text += fmt::format(
          "| {} {} | {} | {} | {} | {} | {:+.2f} to {:+.2f} | {} |\n",
          a.at("removed").get<bool>() ? "removed:" : "added:", a.at("meaning").get<std::string>(),
          a.at("why").get<std::string>(), CaseFrom(a.at("case")).Label(), fraction(a.at("before")),
          fraction(a.at("after")), a.at("low").get<double>(), a.at("high").get<double>(),
          a.at("effect").get<std::string>());
    }
  }
  for (const Json& s : scenes.at("scenes")) {
    if (!s.contains("map")) continue;
    text += fmt::format("\n## Map of {}\n\n| length | filter |", s.at("name").get<std::string>());
    for (const double mu : MapMus()) text += fmt::format(" {:g} |", mu);
    text += "\n|---|---|";
    for (std::size_t i = 0; i < MapMus().size(); ++i) text += "--:|";
    std::string before;
    for (const Json& cell : s.at("map")) {
      const Case c = CaseFrom(cell.at("case"));
      if (c.length + c.filter != before) text += fmt::format("\n| {} | {} |", c.length, c.filter);
      before = c.length + c.filter;
      const Json& fails = cell.at("figures").at("fails");
      text += fmt::format(" {:.0f} |",
                          100 * fails.at("count").get<double>() / fails.at("of").get<double>());
    }
    text += "\n";
  }
  if (std::ranges::any_of(scenes.at("scenes"),
                          [](const Json& s) { return s.contains("prediction"); })) {
    text +=
        "\n## Does an error predict failing\n\n| scene | lengths and masses | distance | step "
        "error "
        "|\n|---|--:|--:|--:|\n";
  }
  for (const Json& s : scenes.at("scenes")) {
    if (!s.contains("prediction")) continue;
    const Json& p = s.at("prediction");
    text += fmt::format("| `{}` | {} | {:.2f} | {:.2f} |\n", s.at("name").get<std::string>(),
                        p.at("groups").get<int>(), p.at("distance").get<double>(),
                        p.at("step_error").get<double>());
  }
  return text;
}

std::string SceneTable() {
  std::string table;
  for (const Scene& scene : AllScenes()) {
    table += fmt::format("{}\n  {}  {}", scene.name, Wrapped(scene.claim, 4),
                         Wrapped(fmt::format("uses {}", scene.uses), 4));
  }
  return table;
}

std::string RecordedText(const std::string& command, const Contacts& contacts,
                         const Recorder& recorder) {
  std::string text = fmt::format("# {}\n# stencil={} k={:.17g} eps={:.17g}\n", command,
                                 contacts.stencil, contacts.k, contacts.eps);
  for (int v = 0; v < 4; ++v) text += fmt::format("x{0},y{0},z{0},", v);
  text += "side\n";
  for (std::size_t i = 0; i < recorder.side.size(); ++i) {
    for (std::size_t j = 0; j < 12; ++j) text += fmt::format("{:.17g},", recorder.x[12 * i + j]);
    text += fmt::format("{:g}\n", recorder.side[i]);
  }
  return text;
}

}  // namespace definite::scenes
