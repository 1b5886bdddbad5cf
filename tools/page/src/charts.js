// The charts, as Vega-Lite specifications with their data in them. `width` is that of the page.
import { costs, errors, familyNames, familyOf, groupBy, pareto, points, replay, split, times } from "./data.js";

// Okabe and Ito's colours, which people tell apart however they see colour; black and yellow, which
// one of the two backgrounds would swallow, are replaced.
const colours = ["#0072b2", "#009e73", "#cc79a7", "#d55e00", "#e69f00", "#56b4e9", "#a6761d", "#888888"];
const family = { field: "family", type: "nominal", title: "filter", scale: { domain: familyNames, range: colours } };

const log = (field, title, extra = {}) =>
  ({ field, type: "quantitative", title, scale: { type: "log", nice: false, padding: 12 },
     axis: { format: ".0e", labelOverlap: true, tickCount: 5 }, ...extra });

// As many panels side by side as there is room for, beside an axis whose labels take `labels`.
const panels = (width, count, { least = 300, labels = 70 } = {}) => {
  const columns = Math.max(1, Math.min(count, Math.floor((width - labels) / least)));
  return { columns, width: Math.max(140, Math.floor((width - labels) / columns) - 36) };
};
const short = (energy) => energy.replace(/^collision\//, "");
const groups = (rows) => [...groupBy(rows, (r) => r.panel).values()];
// A panel for each value of that field.
const panelled = (values, { columns, width }) => ({
  data: { values },
  facet: { field: "panel", type: "nominal",
           header: { title: null, labelFontSize: 11, labelFontWeight: "bold", labelLimit: width } },
  columns,
});

const tooltip = [
  ["kernel"], ["distribution"], ["x", "cost", ".4g"], ["median", "median", ".3g"], ["p99", "p99", ".3g"],
  ["max", "worst", ".3g"], ["source"], ["replay", "replay the worst"],
].map(([field, title, format]) =>
  ({ field, title: title ?? field, type: format ? "quantitative" : "nominal", ...(format && { format }) }));

// Cost against error, a panel for each energy and distribution.
export function paretoChart(rows, width, { cost, error }) {
  const values = groups(points(rows, cost, error)).flatMap(pareto);
  if (!values.length) return null;
  const size = panels(width, groups(values).length);
  const point = { x: log("x", costs[cost].title, { axis: { format: "~g", labelOverlap: true, tickCount: 5 } }), y: log("y", errors[error].title) };
  return {
    ...panelled(values, size),
    spec: {
      width: size.width,
      height: Math.min(420, Math.max(200, Math.round(0.75 * size.width))),
      layer: [
        { transform: [{ filter: "datum.hull" }],
          mark: { type: "line", strokeDash: [4, 3], opacity: 0.6, color: "#888" },
          encoding: { ...point, order: { field: "x", type: "quantitative" } } },
        { mark: { type: "rule", opacity: 0.35 },
          encoding: { ...point, y2: { field: "y_high" }, color: family,
                      opacity: { condition: { test: "datum.dominated", value: 0.15 }, value: 0.5 } } },
        ...[true, false].map((psd) => ({
          transform: [{ filter: `datum.psd === ${psd}` }],
          mark: { type: "point", strokeWidth: 2, size: 60, filled: psd },
          encoding: {
            ...point, color: family, tooltip,
            shape: { field: "scalar", type: "nominal", title: "numbers" },
            opacity: { condition: { test: "datum.dominated", value: 0.3 }, value: 1 },
          },
        })),
        // Neighbours are named above and below in turn; the dearest stands at the right edge.
        { transform: [{ filter: "!datum.dominated" }],
          mark: { type: "text", fontSize: 10, limit: 110,
                  align: { expr: "datum.dearest ? 'right' : 'left'" }, dx: { expr: "datum.dearest ? -7 : 7" },
                  dy: { expr: "datum.below ? 10 : -8" } },
          encoding: { ...point, text: { field: "filter" } } },
      ],
    },
    resolve: { scale: { x: "shared", y: "shared" } },
  };
}

// How the distance to the nearest matrix is distributed over the configurations, in steps of a
// quarter of a decade.
export function distributionChart(rows, width) {
  const values = rows.flatMap((r) => {
    const histogram = r.row.accuracy.distance.histogram;
    if (!histogram) return [];
    const all = histogram.reduce((sum, [, count]) => sum + count, 0);
    const steps = groupBy(histogram, ([value]) => value > 0 ? Math.floor(4 * Math.log10(value)) : -72);
    return [...steps].map(([step, part]) => ({
      panel: r.panel, kernel: r.kernel, filter: r.filter, family: r.family,
      distance: 10 ** ((step + 0.5) / 4),
      share: part.reduce((sum, [, count]) => sum + count, 0) / all,
    }));
  });
  if (!values.length) return null;
  const size = panels(width, groups(values).length);
  return {
    ...panelled(values, size),
    spec: {
      width: size.width, height: 180,
      mark: { type: "line", interpolate: "step", strokeWidth: 1.5, point: { size: 12 } },
      encoding: {
        x: log("distance", errors.distance.title),
        y: { field: "share", type: "quantitative", title: "share of configurations", axis: { format: "%" } },
        color: family,
        detail: { field: "kernel" },
        tooltip: [{ field: "kernel" }, { field: "distance", format: ".2g" }, { field: "share", format: ".3%" }],
      },
    },
  };
}

// Whether the answer depends on how the vertices are numbered: from the median to the worst.
export function relabellingChart(rows, width) {
  const shown = (v) => Math.max(typeof v === "number" ? v : 1e3, 1e-17);  // "inf" stands at the edge
  const values = rows.flatMap(({ row, operations, ...r }) => {
    const found = errors.relabelling.of(row);
    return found ? [{ ...r, name: `${r.filter}/${r.scalar}`, median: found.value, p99: found.high, max: found.max,
                      from: shown(found.value), to: shown(found.max), replay: replay(r, row.accuracy.relabelling.max.index) }] : [];
  });
  if (!values.length) return null;
  const size = panels(width, groups(values).length, { labels: 160 });
  return {
    ...panelled(values, size),
    spec: {
      width: size.width,
      layer: [
        { mark: { type: "rule", strokeWidth: 2, opacity: 0.5 }, encoding: { x: log("from", errors.relabelling.title), x2: { field: "to" } } },
        { mark: { type: "point", filled: true, size: 50 }, encoding: { x: log("from", errors.relabelling.title), tooltip } },
        { mark: { type: "tick", thickness: 2 }, encoding: { x: log("to", errors.relabelling.title), tooltip } },
      ],
      encoding: { y: { field: "name", type: "nominal", title: null, sort: null }, color: family },
    },
  };
}

export const ringsOf = (speed) => [...new Set(speed.rows.filter((r) => r.floor && r.threads === 1).map((r) => r.ring))];

// Each kernel beside the least time that this machine's arithmetic and stores allow.
export function floorChart(speed, width, { ring }) {
  const values = speed.rows.filter((r) => r.floor && r.threads === 1 && r.ring === ring).map((r) => ({
    kernel: r.kernel, output: r.output, ring: r.ring, panel: short(split(r).energy), name: split(r).name, ns: r.ns_per_hessian.median,
    floor: r.floor.ns, times: r.ns_per_hessian.median / r.floor.ns, binds: r.floor.binds,
  }));
  if (!values.length) return null;
  const each = groups(values).sort((a, b) => b.length - a.length);  // panels of a row are of one size
  const columns = Math.max(1, Math.floor(width / 600));
  const domain = [Math.min(...values.map((v) => v.floor)) / 1.3, Math.max(...values.map((v) => v.ns)) * 1.3];
  const scale = { type: "log", domain, nice: false }, axis = { format: "~g", tickCount: 5 };
  const title = "ns per Hessian";
  return {
    data: { values },
    columns,
    concat: each.map((panel) => ({
      transform: [{ filter: { field: "panel", equal: panel[0].panel } }],
      title: { text: panel[0].panel, fontSize: 12 },
      width: Math.max(120, Math.floor(width / columns) - 230),
      encoding: { y: { field: "name", type: "nominal", title: null, axis: { labelLimit: 170 } } },
      layer: [
        { mark: { type: "rule", strokeWidth: 2, opacity: 0.5, color: "#888" },
          encoding: { x: { field: "floor", type: "quantitative", scale, axis, title }, x2: { field: "ns" } } },
        { mark: { type: "tick", thickness: 3 },
          encoding: { x: { field: "floor", type: "quantitative", scale, axis, title },
                      color: { field: "binds", title: "the floor is of", type: "nominal", scale: { domain: ["arithmetic", "division", "stores"], range: colours } } } },
        { mark: { type: "point", filled: true, size: 45, color: "#888" },
          encoding: { x: { field: "ns", type: "quantitative", scale, axis, title },
                      tooltip: [{ field: "kernel" }, { field: "output" }, { field: "ns", format: ".3g" }, { field: "floor", format: ".3g" },
                                { field: "times", title: "times the floor", format: ".2f" }, { field: "binds" }] } },
      ],
    })),
  };
}

// Where the seconds of a whole job go. Each stage was timed with those before it: a difference may be
// below 0 by what two timings differ.
export function stagesChart(speed, width) {
  const values = (speed?.jobs ?? []).flatMap(({ kernel, threads, seconds: s }) =>
    Object.entries({ "draw the inputs": s.draw, frame: s.frame, Hessian: s.hessian - s.frame, "filter and write": s.packed - s.hessian })
      .map(([stage, seconds], order) => ({ stage, seconds: Math.max(0, seconds), order, kernel, threads,
                                           name: `${short(kernel).replace("/analytic/f64x8", "")}, ${threads} thread${threads > 1 ? "s" : ""}` })));
  if (!values.length) return null;
  const labels = Math.min(260, 0.4 * width);
  return {
    data: { values },
    width: Math.max(120, width - labels - 50),
    mark: "bar",
    encoding: {
      y: { field: "name", type: "nominal", title: null, axis: { labelLimit: labels } },
      x: { field: "seconds", type: "quantitative", title: "seconds for the job" },
      color: { field: "stage", type: "nominal", sort: null, scale: { range: colours } },
      order: { field: "order" },
      tooltip: [{ field: "kernel" }, { field: "stage" }, { field: "seconds", format: ".3g" }],
    },
  };
}

// What each kernel took in run after run of one machine.
export function historyChart(results, width) {
  const values = times(results).map(({ energy, ...t }) => ({ panel: short(energy), ...t }));
  if (!values.length) return null;
  const size = panels(width, groups(values).length);
  const y = { type: "quantitative", title: "ns per Hessian", scale: { type: "log", nice: false, padding: 8 }, axis: { format: "~g", tickCount: 5 } };
  const detail = [{ field: "kernel" }, { field: "distribution" }];
  return {
    ...panelled(values, size),
    spec: {
      width: size.width, height: 260,
      encoding: { x: { field: "run", type: "ordinal", title: "run", axis: { labelAngle: 0 } }, color: family, detail },
      layer: [
        { mark: { type: "line", strokeWidth: 1.5 }, encoding: { y: { field: "ns", ...y } } },
        { mark: { type: "rule", strokeWidth: 3, opacity: 0.4 }, encoding: { y: { field: "low", ...y }, y2: { field: "high" } } },
        { mark: { type: "point", filled: true, size: 30 },
          encoding: { y: { field: "ns", ...y },
                      tooltip: [{ field: "kernel" }, { field: "distribution" }, { field: "file" }, { field: "commit" }, { field: "ns", format: ".3g" },
                                { field: "low", format: ".3g" }, { field: "high", format: ".3g" }] } },
      ],
    },
    resolve: { scale: { y: "independent" } },
  };
}

// The verdicts, from the best on, in colours that do not rely on red and green.
const verdicts = { pass: "#56b4e9", degraded: "#e69f00", non_psd: "#d55e00", silent_zero: "#cc79a7", inconsistent: "#a6761d", non_finite: "#7b3294", crash: "#888888" };

export const mapErrors = {
  rounding: "largest rounding (test ratio)", distance: "largest distance to the nearest PSD matrix",
  psd_defect: "largest PSD defect (test ratio)", relabelling: "largest spread over vertex numberings",
};

// How a filter fares on the way to a degeneracy: delta shrinks to the right, and is 0 at the end.
export function degeneracyChart(maps, width, { energy, error, filter }) {
  const least = 1e-18, most = 1e18;
  const values = maps.filter((m) => m.energy === energy && (filter === "all" || m.filter === filter)).flatMap((m) =>
    (m[error] ?? []).flatMap((value, decade) => value === null || value === undefined ? [] : [{
      panel: m.family, filter: m.filter, decade, value, verdict: m.verdict[decade] ?? "pass",
      delta: decade === 16 ? "0" : `1e-${decade + 1} to 1e-${decade}`,
      y: Math.min(most, Math.max(least, typeof value === "number" ? value : most)),
    }]));
  if (!values.length) return null;
  // Filters that fail are named where they are worst, from the worst on, as long as there is room.
  for (const panel of groups(values)) {
    const named = [];
    const worst = [...groupBy(panel, (v) => v.filter).values()].map((line) => line.reduce((a, b) => (b.y > a.y ? b : a)));
    for (const v of worst.filter((p) => p.verdict !== "pass" && p.filter !== "none").sort((a, b) => b.y - a.y)) {
      v.named = named.every((n) => Math.abs(n.decade - v.decade) > 6 || Math.abs(Math.log10(n.y / v.y)) > 3);
      if (v.named) named.push(v);
    }
  }
  const size = panels(width, groups(values).length);
  const x = { field: "decade", type: "quantitative", title: "-log10 of delta (at the end delta = 0)", scale: { domain: [-0.5, 16.5], nice: false }, axis: { values: [0, 4, 8, 12, 16] } };
  const y = log("y", mapErrors[error]);
  return {
    ...panelled(values, size),
    spec: {
      width: size.width, height: 220,
      encoding: { x, y, detail: { field: "filter" } },
      layer: [
        { mark: { type: "line", strokeWidth: 1, color: "#888", opacity: 0.5, clip: true } },
        { mark: { type: "point", filled: true, size: 30, clip: true },
          encoding: {
            color: { field: "verdict", type: "nominal", title: "worst verdict", scale: { domain: Object.keys(verdicts), range: Object.values(verdicts) } },
            tooltip: [{ field: "filter" }, { field: "panel", title: "family" }, { field: "delta" }, { field: "value", title: mapErrors[error] }, { field: "verdict" }],
          } },
        { transform: [{ filter: "datum.named" }],
          mark: { type: "text", fontSize: 10, dy: -8, limit: 110, clip: true, align: { expr: "datum.decade > 8 ? 'right' : 'left'" } },
          encoding: { text: { field: "filter" } } },
      ],
    },
  };
}

// What can be counted of the starts of a scene, and what the filter takes of a step.
export const mapFigures = {
  fails: "starts that fail", booms: "starts that boom", pops: "starts that pop through", penetrates: "starts that end on a wrong side",
  jitters: "starts that jitter", indefinite: "starts that meet an indefinite system", kernel_share: "share of the filter in the time of a step",
};

// Where a scene is stable: filters against mu, a panel for each length.
export function stabilityChart(scene, width, { figure }) {
  const values = scene.map.map(({ case: c, figures, timing }) => {
    const found = figures[figure];
    const fraction = figure === "kernel_share" ? timing.kernel_share : found.count / found.of;
    return { panel: c.length, filter: c.filter, mu: c.mu, fraction, percent: Math.round(100 * fraction), ...(found && { low: found.low, high: found.high, starts: found.of }),
             microseconds: timing.ns_per_step / 1000, kernel_share: timing.kernel_share };
  });
  const filters = [...new Set(values.map((v) => v.filter))];
  const labels = 130, many = new Set(values.map((v) => v.mu)).size;
  const size = panels(width, groups(values).length, { least: 380, labels });
  const cell = (size.width - (size.columns > 1 ? labels * (size.columns - 1) / size.columns : 0)) / many;
  return {
    ...panelled(values, size),
    spec: {
      width: cell * many, height: 22 * filters.length,
      encoding: {
        x: { field: "mu", type: "ordinal", title: "mu = dt\u00b2 k / m", axis: { labelAngle: 0, labelOverlap: true, format: "~g" } },
        y: { field: "filter", type: "nominal", sort: filters, title: null },
        tooltip: [
          { field: "panel", title: "length" }, { field: "filter" }, { field: "mu" }, { field: "fraction", title: mapFigures[figure], format: ".0%" },
          ...(figure === "kernel_share" ? [] : [{ field: "low", title: "95 % from", format: ".0%" }, { field: "high", title: "95 % to", format: ".0%" }, { field: "starts" }]),
          { field: "microseconds", title: "microseconds per step", format: ".3g" }, { field: "kernel_share", title: "the filter's share", format: ".0%" },
        ],
      },
      layer: [
        { mark: "rect",
          encoding: { color: { field: "fraction", type: "quantitative", title: mapFigures[figure], legend: { format: "%", values: [0, 0.5, 1] },
                               scale: { domain: [0, 1], range: ["#f7e7a8", "#e69f00", "#d55e00", "#4b1010"] } } } },
        { mark: { type: "text", fontSize: cell < 24 ? 8 : 10 },
          encoding: { text: { field: "percent" }, color: { condition: { test: "datum.fraction > 0.5", value: "#fff" }, value: "#222" } } },
      ],
    },
    resolve: { axis: { x: "independent" } },
  };
}

export const predictors = { distance: "median distance to the nearest PSD matrix", step_error: "median error of a contact's step" };

// Failing fraction against what a filter gets wrong on the contacts that the scene meets.
export function predictionChart(scene, width, { error }) {
  const values = scene.map.filter((cell) => cell.error).map(({ case: c, figures: { fails }, error: e }) => ({
    panel: c.length, filter: c.filter, family: familyOf(c.filter), mu: c.mu, fraction: fails.count / fails.of, low: fails.low, high: fails.high,
    error: e[error], x: Math.max(1e-17, e[error]), contacts: e.contacts,
  }));
  if (!values.length) return null;
  const size = panels(width, groups(values).length);
  return {
    ...panelled(values, size),
    spec: {
      width: size.width, height: 220,
      mark: { type: "point", filled: true, size: 40, opacity: 0.8 },
      encoding: {
        x: log("x", predictors[error]),
        y: { field: "fraction", type: "quantitative", title: "starts that fail", axis: { format: "%" } },
        color: family,
        tooltip: [{ field: "filter" }, { field: "panel", title: "length" }, { field: "mu" }, { field: "fraction", title: "starts that fail", format: ".0%" },
                  { field: "low", title: "95 % from", format: ".0%" }, { field: "high", title: "95 % to", format: ".0%" },
                  { field: "error", title: predictors[error], format: ".3g" }, { field: "contacts" }],
      },
    },
  };
}
