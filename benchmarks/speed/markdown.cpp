#include "benchmarks/plans/markdown.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "benchmarks/harness/report.hpp"
#include "benchmarks/plans/result.hpp"
#include "benchmarks/speed/speed.hpp"

namespace definite {

namespace {

using Json = nlohmann::ordered_json;

const Json* FindRow(const Json& result, const std::string& kernel, const std::string& ring,
                    int threads) {
  for (const Json& row : result.at("speed").at("rows")) {
    if (row.at("kernel") == kernel && row.at("ring") == ring && row.at("threads") == threads) {
      return &row;
    }
  }
  return nullptr;
}

// Nanoseconds of a core: on several threads as if each had the job alone.
double NsOf(const Json& result, const std::string& kernel, const std::string& ring = "L1",
            int threads = 1) {
  const Json* const row = FindRow(result, kernel, ring, threads);
  if (!row || row->at("ns_per_hessian").is_null()) {
    throw std::runtime_error(
        fmt::format("the result lacks {}, outputs in {}, {} threads", kernel, ring, threads));
  }
  return threads * row->at("ns_per_hessian").at("median").get<double>();
}

std::string Number(double value) {
  return fmt::format("{:.{}f}", value, value < 10 ? 2 : value < 100 ? 1 : 0);
}

// Seconds for 10^7 in Table 1 of Shi & Kim 2023, analytic and Gauss-Newton.
struct Study {
  std::string label, energy;
  double analytic, gauss_newton;
};
const std::vector<Study> kStudies = {
    {"vertex-face", "collision/vertex_face/signed/quadratic/", 12.31, 11.12},
    {"edge-edge", "collision/edge_edge/signed/quadratic/", 13.01, 12.04}};

// "vertex_face/signed/quadratic/analytic" of "collision/.../f64x8".
std::string ShortName(const std::string& kernel) {
  const std::size_t family = std::string("collision/").size();
  return kernel.substr(family, kernel.rfind('/') - family);
}

std::string Overheads(const Json& result) {
  std::vector<std::vector<std::string>> table = {{"what is timed", "", "analytic", "G-N", "ratio"}};
  for (const Study& study : kStudies) {
    const auto add = [&](const std::string& what, double analytic, double gauss_newton) {
      table.push_back({what, study.label, Number(analytic), Number(gauss_newton),
                       fmt::format("{:.2f}", analytic / gauss_newton)});
    };
    const auto ns = [&](const std::string& row, const std::string& ring = "L1", int threads = 1) {
      return NsOf(result, study.energy + row, ring, threads);
    };
    add("Shi & Kim 2023, Table 1", study.analytic * 100, study.gauss_newton * 100);
    add("both through the frame", ns("analytic_frame/f64"), ns("gauss_newton_frame/f64"));
    add("frame against outer product", ns("analytic_frame/f64"), ns("gauss_newton/f64"));
    add("both in x, scalar", ns("analytic/f64"), ns("gauss_newton/f64"));
    for (const std::string ring : {"L1", "L2", "memory"}) {
      add("both on 8 lanes, to " + ring, ns("analytic/f64x8", ring),
          ns("gauss_newton/f64x8", ring));
    }
    add("the same, 2 threads", ns("analytic/f64x8", "memory", 2),
        ns("gauss_newton/f64x8", "memory", 2));
    add("8 lanes against scalar G-N", ns("analytic/f64x8"), ns("gauss_newton/f64"));
  }
  return "### Analytic over Gauss-Newton, by what one times\n\n" + MarkdownTable(table) +
         Paragraph(
             "Nanoseconds of one core for a Hessian, and their ratio; outputs in L1 where nothing "
             "else is said. Through the frame: 12x9 and 9x9 products in Eigen. In x: modes summed "
             "in x-space, Gauss-Newton being one outer product of a 12-vector.");
}

std::string RowsTable(const Json& result, const std::string& energy) {
  std::vector<std::vector<std::string>> table = {
      {"row", "ns", "95 %", "numeric /", "G-N /", "floor", "x floor"}};
  for (const Json& row : result.at("speed").at("rows")) {
    const std::string kernel = row.at("kernel");
    if (!kernel.starts_with(energy) || row.at("ring") != "L1" || row.at("threads") != 1) continue;
    const Json &time = row.at("ns_per_hessian"), &floor = row.at("floor");
    if (time.is_null()) continue;
    const double median = time.at("median");
    const auto ratio = [&row](const char* baseline) -> std::string {
      const Json& estimate = row.at("ratio_to").at(baseline);
      return estimate.is_null() ? "-" : Number(estimate.at("median"));
    };
    table.push_back(
        {kernel.substr(energy.size()), Number(median),
         fmt::format("{} - {}", Number(time.at("low")), Number(time.at("high"))), ratio("numeric"),
         ratio("gauss_newton"), floor.is_null() ? "-" : Number(floor.at("ns")),
         floor.is_null() ? "-" : fmt::format("{:.2f}", median / floor.at("ns").get<double>())});
  }
  return MarkdownTable(table);
}

std::string Rows(const Json& result) {
  std::string text;
  for (const Study& study : kStudies) {
    text += fmt::format("\n### Every row of signed {}, quadratic\n\n", study.label) +
            RowsTable(result, study.energy);
  }
  return text + Paragraph(
                    "One thread, outputs in L1; numeric and G-N: how many times faster than the "
                    "scalar packed row of that filter. The floor is what the row's arithmetic, its "
                    "divisions and roots or its stores take alone at the rates of this run.");
}

std::string Jobs(const Json& result) {
  std::vector<std::vector<std::string>> table = {
      {"analytic, 8 lanes", "threads", "draw", "frame", "Hessian", "write", "seconds", "speed-up"}};
  std::string kernel;
  double alone = 0;
  for (const Json& job : result.at("speed").at("jobs")) {
    const std::string name = job.at("kernel");
    if (!name.ends_with("/analytic/f64x8")) continue;
    const Json& seconds = job.at("seconds");
    const auto ns = [&](double s) { return Number(s * 1e9 / job.at("count").get<double>()); };
    const double draw = seconds.at("draw"), frame = seconds.at("frame"),
                 hessian = seconds.at("hessian"), packed = seconds.at("packed"),
                 total = seconds.at("total");
    if (kernel != name) alone = total;
    kernel = name;
    table.push_back({ShortName(name).substr(0, ShortName(name).rfind("/quadratic")),
                     fmt::format("{}", job.at("threads").get<int>()), ns(draw), ns(frame),
                     ns(hessian - frame), ns(packed - hessian), fmt::format("{:.2f}", total),
                     fmt::format("{:.2f}", alone / total)});
  }
  return "\n### The whole job, inputs drawn\n\n" + MarkdownTable(table) +
         Paragraph(
             "Quadratic energies; nanoseconds a configuration by stage, and seconds for all of "
             "them. Wall time, outputs in L1.");
}

std::string Assemblies(const Json& result) {
  if (result.at("speed").at("assemblies").empty()) return "";  // --elements 0
  std::vector<std::vector<std::string>> table = {
      {"row, 8 lanes", "threads", "row alone", "scatter-added", "speed-up"}};
  std::string kernel;
  double alone = 0;
  for (const Json& one : result.at("speed").at("assemblies")) {
    const std::string name = one.at("kernel");
    const double ns = one.at("assembled_ns").at("median");
    if (kernel != name) alone = ns;
    kernel = name;
    table.push_back({ShortName(name), fmt::format("{}", one.at("threads").get<int>()),
                     Number(one.at("kernel_ns").at("median")), Number(ns),
                     fmt::format("{:.2f}", alone / ns)});
  }
  const Json& first = result.at("speed").at("assemblies").at(0);
  return "\n### Scatter-add to a block-sparse matrix\n\n" + MarkdownTable(table) +
         Paragraph(fmt::format(
             "Nanoseconds an element: {} elements on half as many vertices, gathered, filtered "
             "and added to {} blocks, colour by colour ({} colours for vertex-face). Wall time; "
             "the row alone on one thread, its outputs in L1.",
             WithCommas(first.at("elements").get<std::uint64_t>()),
             WithCommas(first.at("blocks").get<std::uint64_t>()), first.at("colours").get<int>()));
}

}  // namespace

std::string ToMarkdown(const Json& result) {
  return Overheads(result) + Rows(result) + Jobs(result) + Assemblies(result) + Provenance(result);
}

}  // namespace definite
