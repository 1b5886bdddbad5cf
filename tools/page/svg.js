// The chart of cost against error as SVG: node svg.js RESULT.json OUT.svg [PANEL]...
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { parse, View } from "vega";
import { compile } from "vega-lite";
import { paretoChart } from "./src/charts.js";
import { rowsOf } from "./src/data.js";
import { theme } from "./src/theme.js";

const [file, out, ...only] = process.argv.slice(2);
const rows = rowsOf([{ file, json: JSON.parse(readFileSync(file, "utf8")) }])
  .filter((r) => only.length === 0 || only.includes(r.panel));
const spec = paretoChart(rows, 980, { cost: "ns", error: "distance" });
const view = new View(parse(compile({ ...spec, config: { ...theme(false, 980), background: "#fff", font: "sans-serif" } }).spec), { renderer: "none" });
writeFileSync(`${out}.tmp`, `${await view.toSVG()}\n`);
renameSync(`${out}.tmp`, out);
