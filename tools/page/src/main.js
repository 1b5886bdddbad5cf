import { parse, View } from "vega";
import { compile } from "vega-lite";
import { Handler } from "vega-tooltip";
import { degeneracyChart, distributionChart, floorChart, historyChart, mapErrors, mapFigures, paretoChart, predictionChart, predictors, relabellingChart, ringsOf, stabilityChart, stagesChart } from "./charts.js";
import { costs, errors, points, rowsOf } from "./data.js";
import { csv, fromMarkdown, save } from "./tables.js";
import { theme } from "./theme.js";

const { results, history } = JSON.parse(document.getElementById("data").textContent);
const shown = history ? results.slice(-1) : results;  // of a history the charts of one run show the last
const rows = rowsOf(shown);
const main = document.querySelector("main");
const dark = matchMedia("(prefers-color-scheme: dark)");
const redraws = [];

function element(tag, properties = {}, ...children) {
  const e = Object.assign(document.createElement(tag), properties);
  e.append(...children);
  return e;
}

function section(id, title, says) {
  const s = element("section", { id }, element("h2", { textContent: title }), element("p", { className: "says", textContent: says }));
  main.append(s);
  document.querySelector("nav").append(element("a", { href: `#${id}`, textContent: title }));
  return s;
}

function picker(name, options, chosen, change) {
  const select = element("select", { name });
  for (const [value, text] of options) select.append(element("option", { value, textContent: text, selected: value === chosen }));
  select.addEventListener("change", () => change(select.value));
  return element("label", {}, `${name} `, select);
}

// A chart made by `make(width)`, drawn again when the page's width or colours change; what it shows
// is there as CSV.
function chart(into, make, name) {
  const tools = element("div", { className: "tools" });
  const place = element("div", { className: "wide chart" });
  into.append(tools, place);
  let view, spec;
  const draw = async () => {
    spec = make(place.clientWidth || main.clientWidth);
    view?.finalize();
    view = null;
    place.replaceChildren();
    if (!spec) return void place.append(element("p", { textContent: "There is no data for this choice." }));
    view = new View(parse(compile({ ...spec, config: theme(dark.matches, place.clientWidth) }).spec), {
      renderer: "svg", container: place, hover: true,
      tooltip: new Handler({ theme: dark.matches ? "dark" : "light" }).call,
    });
    await view.runAsync();
  };
  tools.append(element("button", { type: "button", textContent: "CSV", onclick: () => save(`${name}.csv`, csv(spec?.data.values ?? [])) }));
  redraws.push(draw);
  draw();
  return { tools, draw };
}

if (rows.length) {
  const choice = { cost: rows.some((r) => costs.ns.of(r.row)) ? "ns" : "flops", error: "distance" };
  const has = (cost, error) => points(rows, cost, error).length > 0;
  if (has(choice.cost, choice.error)) {
    const s = section("pareto", "Cost against error", "Each point is a filter. Lower is nearer to its aim, left is cheaper. A whisker goes from the median to the 99th percentile; a hollow point is not always PSD; a faint one is beaten in both by another; the dashed line is the convex hull of those that are not. An error of 0 stands at the lower edge, an infinite one at the upper.");
    const { tools, draw } = chart(s, (width) => paretoChart(rows, width, choice), "pareto");
    const pickers = [["error", errors], ["cost", costs]].map(([axis, all]) =>
      [axis, picker(axis, Object.entries(all).map(([key, { title }]) => [key, title]), choice[axis], (value) => { choice[axis] = value; usable(); draw(); })]);
    // What has no points beside the other choice cannot be chosen.
    const usable = () => {
      for (const [axis, label] of pickers) {
        for (const option of label.querySelectorAll("option")) {
          option.disabled = axis === "cost" ? !has(option.value, choice.error) : !has(choice.cost, option.value);
        }
      }
    };
    for (const [, label] of pickers) tools.prepend(label);
    usable();
  }
  if (distributionChart(rows, 900)) {
    chart(section("distribution", "How far from the nearest PSD matrix", "The share of configurations at each distance, relative to the norm of the Hessian's nearest PSD matrix, in steps of a quarter of a decade."), (width) => distributionChart(rows, width), "distribution");
  }
  if (relabellingChart(rows, 900)) {
    chart(section("relabelling", "Does the answer depend on vertex numbering", "How much the filtered matrix changes when the vertices are numbered otherwise: a dot at the median, a tick at the worst. At rounding it does not depend on the numbering."), (width) => relabellingChart(rows, width), "relabelling");
  }
}

const maps = shown.flatMap(({ json }) => json.maps ?? []);
if (maps.length) {
  const energies = [...new Set(maps.map((m) => m.energy))], filters = [...new Set(maps.map((m) => m.filter))];
  const choice = { energy: energies.find((name) => name.endsWith("vertex_face/signed/quadratic")) ?? energies[0], error: "rounding", filter: "all" };
  const s = section("degeneracy", "What breaks near a degeneracy", "Each panel is a family of configurations that become degenerate as delta goes to 0, on the right. A line is a filter: the largest error in each decade of delta, in the colour of the worst verdict there. Rounding is what was looked at in float128: a sample, worst cases, and what was in doubt.");
  const { tools, draw } = chart(s, (width) => degeneracyChart(maps, width, choice), "degeneracy");
  const offer = (name, all) => picker(name, all, choice[name], (value) => { choice[name] = value; draw(); });
  tools.prepend(offer("energy", energies.map((e) => [e, e])), offer("error", Object.entries(mapErrors)), offer("filter", ["all", ...filters].map((f) => [f, f])));
}

const stable = shown.flatMap(({ json }) => json.scenes ?? []).filter((scene) => scene.map);
stable.forEach((scene, i) => {
  const choice = { figure: "fails" };
  const s = section(stable.length > 1 ? `stability-${i + 1}` : "stability", `Where a simulation fails: ${scene.name}`, `${scene.claim}. A cell has, in percent, how many of the scene's random starts fail: mu is the stiffness of contact in units of mass over time step squared.`);
  const { tools, draw } = chart(s, (width) => stabilityChart(scene, width, choice), `stability-${scene.name}`);
  tools.prepend(picker("figure", Object.entries(mapFigures), choice.figure, (value) => { choice.figure = value; draw(); }));

  if (!scene.prediction) return;
  const { groups, distance, step_error } = scene.prediction, predictor = { error: "step_error" };
  const p = section(`${s.id}-prediction`, `Does an error predict failing: ${scene.name}`, `Each point is a filter at one length and mass. Over the filters of one length and mass, the rank correlation of failing with distance is ${distance.toFixed(2)}, with the error of a contact's step ${step_error.toFixed(2)}: means of ${groups} where not all filters fail alike.`);
  const prediction = chart(p, (width) => predictionChart(scene, width, predictor), `prediction-${scene.name}`);
  prediction.tools.prepend(picker("error", Object.entries(predictors), predictor.error, (value) => { predictor.error = value; prediction.draw(); }));
});

if (history) {
  chart(section("history", "One machine over time", "Time per Hessian in each run, in the order of the files, with its 95 % interval. Neighbouring runs differ by what the machine does besides; definite compare decides."), (width) => historyChart(results, width), "history");
}

shown.filter(({ json }) => json.speed).forEach(({ file, json }, i, all) => {
  const [suffix, whose] = all.length > 1 ? [`-${i + 1}`, `: ${file}`] : ["", ""];
  const rings = ringsOf(json.speed);
  if (rings.length) {
    const choice = { ring: rings[0] };
    const s = section(`floors${suffix}`, `How near to the machine's limit${whose}`, `A tick is the least time that arithmetic, divisions and stores of ${json.machine.cpu} allow; a dot is what the kernel takes, its outputs going to the ring chosen (${file}).`);
    const { tools, draw } = chart(s, (width) => floorChart(json.speed, width, choice), "floors");
    tools.prepend(picker("ring", rings.map((ring) => [ring, ring]), choice.ring, (value) => { choice.ring = value; draw(); }));
  }
  if (stagesChart(json.speed, 900)) {
    chart(section(`stages${suffix}`, `Where the time of a job goes${whose}`, "Drawing the inputs included."), (width) => stagesChart(json.speed, width), "stages");
  }
});

shown.forEach(({ file, markdown }, i) => {
  if (!markdown) return;
  const s = section(`tables-${i + 1}`, `Tables: ${file}`, "A click on a heading sorts.");
  const long = markdown.split("\n").length > 200;  // a reader looks for one of its lines
  s.append(element("details", { open: !long }, element("summary", { textContent: "Show" }), fromMarkdown(markdown, `tables-${i + 1}`)));
});

const footer = document.querySelector("footer");
footer.append(element("h2", { textContent: "Where this comes from" }));
for (const { file, json } of results) {
  const facts = element("dl");
  const fact = (name, value) => value !== undefined && value !== null && facts.append(element("dt", { textContent: name }), element("dd", { textContent: value }));
  fact("command", json.command?.join(" "));
  fact("machine", json.machine && `${json.machine.cpu}, ${json.machine.cores} cores, ${json.machine.os}${json.machine.noisy ? "; noisy while it was measured" : ""}`);
  fact("build", `${json.build.compiler} ${json.build.flags}, ${json.build.isa}, Eigen ${json.build.eigen}, ${json.build.libm}, commit ${json.build.commit}`);
  fact("seed", json.seed);
  fact("protocol", json.protocol);
  footer.append(element("h3", { textContent: file }), facts);
}

let width = main.clientWidth;
addEventListener("resize", () => {
  if (main.clientWidth === width) return;
  width = main.clientWidth;
  for (const draw of redraws) draw();
});
dark.addEventListener("change", () => redraws.forEach((draw) => draw()));
