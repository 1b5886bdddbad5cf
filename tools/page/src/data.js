// Results as rows of plain values: one for each kernel, distribution and file.

// The axes one can choose. `of` gives {value, low, high} of a row, or null.
const timing = (row) => row.timing.find((t) => t.pairs === "all") ?? row.timing[0];
const span = (figure, factor = 1) =>
  figure && { value: factor * figure.median, low: factor * figure.low, high: factor * figure.high };

export const costs = {
  ns: { title: "time per Hessian (ns)", of: (row) => span(timing(row)?.ns_per_hessian) },
  ratio: {
    title: "time / time of numeric (Eigen)",
    of: (row) => {
      const r = timing(row)?.ratio_to.numeric;
      return r && { value: 1 / r.median, low: 1 / r.high, high: 1 / r.low };
    },
  },
  flops: {
    title: "floating-point operations per Hessian",
    of: (row, operations) => {
      const n = operations.get(row.kernel);
      return n && { value: n, low: n, high: n };
    },
  },
};

const figure = (name) => (row) => {
  const f = row.accuracy[name];
  return f && f.count > 0 && f.median !== null ? { value: f.median, high: f.p99, max: f.max.value } : null;
};

export const errors = {
  distance: { title: "distance to the nearest PSD matrix", of: figure("distance") },
  excess: { title: "excess: distance over the least possible", of: figure("excess") },
  rounding: { title: "rounding (test ratio)", of: figure("rounding") },
  psd_defect: { title: "PSD defect (test ratio)", of: figure("psd_defect") },
  relabelling: { title: "spread over vertex numberings", of: figure("relabelling") },
};

// Filters of one kind share a colour.
const families = [
  ["analytic", "analytic"], ["split", "split"], ["nearest", "nearest"], ["numeric", "numeric"],
  ["gauss_newton", "Gauss-Newton"], ["absolute", "absolute"], ["blend", "blend"],
];
export const familyOf = (filter) => families.find(([start]) => filter.startsWith(start))?.[1] ?? "other";
export const familyNames = [...new Set(families.map(([, name]) => name)), "other"];

// Operations of each kernel, where a result of `definite speed` counted them.
function operationsOf(results) {
  const counted = new Map();
  for (const { json } of results) {
    for (const row of json.speed?.rows ?? []) {
      const o = row.floor?.operations;
      if (o) counted.set(row.kernel, o.additions + o.multiplications + 2 * o.fused + o.divisions + o.roots + o.logs);
    }
  }
  return counted;
}

export function rowsOf(results) {
  const operations = operationsOf(results);
  const distributions = new Set(results.flatMap(({ json }) => json.rows.map((row) => row.distribution)));
  const panelOf = (row) => row.energy.replace(/^collision\//, "") + (distributions.size > 1 ? `, ${row.distribution}` : "");
  return results.flatMap(({ file, json }) =>
    json.rows.map((row) => ({
      file, row, operations,
      kernel: row.kernel,
      energy: row.energy,
      filter: row.filter,
      scalar: row.scalar,
      distribution: row.distribution,
      panel: panelOf(row),
      family: familyOf(row.filter),
      psd: row.verdicts.non_psd + row.verdicts.non_finite === 0,
      source: row.source,
      seed: json.seed,
      set: Object.entries(row.set ?? {}).map(([name, value]) => ` --set ${name}=${value}`).join(""),
    })));
}

const forShell = (word) => (/^[\w./=-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
export const replay = (r, index) =>
  `definite replay --kernel ${r.kernel} --distribution ${forShell(r.distribution)} --seed ${r.seed} --index ${index}${r.set}`;

// Two axes of the rows that have both. On a logarithmic axis 0 stands at `least`, "inf" at `most`.
export function points(rows, cost, error) {
  const found = rows.flatMap((r) => {
    const x = costs[cost].of(r.row, r.operations), y = errors[error].of(r.row);
    return x && y && x.value > 0 ? [{ ...r, x, y }] : [];
  });
  const positive = found.flatMap(({ y }) => [y.value, y.high].filter((v) => v > 0));
  const least = positive.length ? Math.min(...positive) / 3 : 1e-17;
  const most = positive.length ? 3 * Math.max(...positive) : 1;
  const shown = (v) => (typeof v !== "number" ? most : v > 0 ? v : least);
  return found.map(({ x, y, row, operations, ...r }) => ({
    ...r,
    x: x.value, x_low: x.low, x_high: x.high,
    y: shown(y.value), y_high: Math.max(shown(y.high), shown(y.value)),
    median: y.value, p99: y.high, max: y.max,
    replay: replay(r, row.accuracy[error].max.index),
  }));
}

// A row of `definite speed`: its energy, and the rest of its name.
export function split({ kernel, output }) {
  const parts = kernel.split("/"), at = parts.length - (parts.at(-1) === output ? 3 : 2);
  return { energy: parts.slice(0, at).join("/"), filter: parts[at], name: parts.slice(at).join("/") };
}

// What each kernel took in each of several runs, in their order; of those that were timed twice.
export function times(results) {
  const all = results.flatMap(({ file, json }, run) => [
    ...json.rows.map((row) => ({ ...row, name: `${row.filter}/${row.scalar}`, ns: timing(row)?.ns_per_hessian })),
    ...(json.speed?.rows ?? []).filter((r) => r.ring === "L1" && r.threads === 1)
      .map((r) => ({ ...split(r), kernel: r.kernel, distribution: json.speed.distribution, ns: r.ns_per_hessian })),
  ].filter(({ ns }) => ns).map(({ kernel, energy, filter, name, distribution, ns }) => ({
    run: run + 1, file, commit: json.build.commit, kernel, energy, filter, name, distribution,
    ns: ns.median, low: ns.low, high: ns.high, family: familyOf(filter),
  })));
  return [...groupBy(all, (t) => `${t.kernel} ${t.distribution}`).values()].filter((of) => of.length > 1).flat();
}

// Marks what another point beats in both axes, and gives the lower left convex hull, on logarithms.
export function pareto(panel) {
  const beats = (a, b) => a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
  for (const p of panel) p.dominated = panel.some((q) => beats(q, p));
  const free = panel.filter((p) => !p.dominated).sort((a, b) => a.x - b.x || a.y - b.y);
  const hull = [];
  const turn = (a, b, c) =>
    Math.log(b.x / a.x) * Math.log(c.y / a.y) - Math.log(b.y / a.y) * Math.log(c.x / a.x);
  for (const p of free) {
    while (hull.length > 1 && turn(hull.at(-2), hull.at(-1), p) <= 0) hull.pop();
    hull.push(p);
  }
  const on = new Set(hull);
  for (const p of panel) {
    const place = free.indexOf(p);
    Object.assign(p, { hull: on.has(p), below: place % 2 === 1, dearest: place > 0 && place === free.length - 1 });
  }
  return panel;
}

// Map.groupBy, which Node.js has from version 21.
export function groupBy(items, key) {
  const groups = new Map();
  for (const item of items) {
    const name = key(item);
    if (groups.has(name)) groups.get(name).push(item);
    else groups.set(name, [item]);
  }
  return groups;
}
