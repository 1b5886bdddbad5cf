// The report page in a browser, opened from disk: node page_test.mjs DEFINITE NPM_FOLDER
//
// Every chart is drawn, nothing is asked of the network, pickers and tables work, at both widths.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";

const [program, npm] = process.argv.slice(-2).map((path) => resolve(path));
const { chromium } = createRequire(join(npm, "package.json"))("playwright-core");
const root = resolve(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "..");
const signed = "collision/vertex_face/signed/quadratic";
const charts = ["pareto", "distribution", "relabelling", "degeneracy", "stability", "stability-prediction", "floors", "stages"];
let folder, page_file, browser;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "page-"));
  const run = (...words) => execFileSync(program, words, { stdio: ["ignore", "ignore", "pipe"] });
  const [sweep, speed, fuzz, map] = ["sweep.json", "speed.json", "fuzz.json", "map.json"].map((name) => join(folder, name));
  run("fuzz", "--count", "2000", "--families", "sliver", "--families", "deep", "--json", fuzz, "--kernels", `${signed}/analytic*`, "--kernels", `${signed}/numeric/*`);
  run("sweep", "--count", "2000", "--set", "k=2", "--json", sweep, ...["none/f64", "analytic/f64x8", "split/f64x8", "nearest/f64x8", "gauss_newton/f64", "numeric/f64"]
    .flatMap((name) => ["--kernels", `${signed}/${name}`]));
  run("speed", "--rounds", "3", "--job", "1e4", "--elements", "0", "--json", speed, "--kernels", `${signed}/analytic/f64x8`,
      "--kernels", `${signed}/gauss_newton/f64x8`);
  run("scene", "cables_popping", "--starts", "2", "--map", "--json", map);
  page_file = join(folder, "report.html");
  run("report", sweep, speed, fuzz, map, join(root, "results/published/shi-kim-2023.json"), "--out", page_file);
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
           "--disable-component-update", "--disable-sync"],
  });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

async function open(width, colorScheme) {
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
  const said = [];
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(error.message));
  page.on("request", (request) => request.url().startsWith("file:") || request.url().startsWith("blob:") || said.push(request.url()));
  await page.goto(`file://${page_file}`);
  for (const id of charts) await page.waitForSelector(`#${id} .chart svg`, { timeout: 20000 });
  return { page, said };
}

const marks = (page, id) => page.locator(`#${id} .chart svg`).locator(".role-mark path, .role-mark line").count();
const text = (page, id) => page.locator(`#${id} .chart svg`).textContent();

for (const [width, scheme] of [[1280, "light"], [400, "dark"]]) {
  test(`every chart is drawn, ${width} pixels wide, ${scheme}`, async () => {
    const { page, said } = await open(width, scheme);
    for (const id of charts) {
      assert.ok(await marks(page, id) > 1, `${id} is empty`);
      const [place, drawn] = await page.locator(`#${id} .chart`).evaluate((e) => [e.clientWidth, e.scrollWidth]);
      assert.ok(drawn <= place + 1, `${id} is ${drawn} pixels wide where there are ${place}`);
    }
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `the page is ${wide} pixels wide`);
    if (process.env.SCREENSHOTS) await page.screenshot({ path: join(process.env.SCREENSHOTS, `page-${width}.png`), fullPage: true });
    assert.deepEqual(said, []);
    await page.close();
  });
}

test("pickers choose the axes", async () => {
  const { page, said } = await open(1280, "light");
  assert.match(await text(page, "pareto"), /distance to the nearest PSD matrix/);
  await page.selectOption("#pareto select[name=error]", "relabelling");
  await page.waitForFunction(() => document.querySelector("#pareto .chart svg")?.textContent.includes("spread over vertex numberings"));
  await page.selectOption("#pareto select[name=cost]", "flops");
  await page.waitForFunction(() => document.querySelector("#pareto .chart svg")?.textContent.includes("floating-point operations"));
  assert.ok(await marks(page, "pareto") > 0);
  const lines = await marks(page, "degeneracy");
  await page.selectOption("#degeneracy select[name=filter]", "numeric");
  await page.waitForFunction((many) => document.querySelectorAll("#degeneracy .chart svg .role-mark path").length < many, lines);
  await page.selectOption("#degeneracy select[name=error]", "psd_defect");
  await page.waitForFunction(() => document.querySelector("#degeneracy .chart svg")?.textContent.includes("PSD defect"));
  const cells = () => page.locator("#stability .chart svg .mark-rect.role-mark path").count();
  const { scenes } = JSON.parse(readFileSync(join(folder, "map.json"), "utf8")).scenes;
  assert.equal(await cells(), scenes[0].map.length);
  await page.selectOption("#stability select[name=figure]", "kernel_share");
  await page.waitForFunction(() => document.querySelector("#stability .chart svg")?.textContent.includes("share of the filter"));
  assert.equal(await cells(), scenes[0].map.length);
  const dots = page.locator("#stability-prediction .chart svg .mark-symbol.role-mark path");
  assert.equal(await dots.count(), scenes[0].map.filter((cell) => cell.error).length);
  await page.selectOption("#stability-prediction select[name=error]", "distance");
  await page.waitForFunction(() => document.querySelector("#stability-prediction .chart svg")?.textContent.includes("distance to the nearest"));
  await page.selectOption("#floors select[name=ring]", "memory");
  assert.ok(await marks(page, "floors") > 1);
  assert.deepEqual(said, []);
  await page.close();
});

test("a point tells its name, numbers and replay command", async () => {
  const { page } = await open(1280, "light");
  await page.locator("#pareto .mark-symbol.role-mark path").last().hover();
  const tooltip = page.locator("#vg-tooltip-element");
  await tooltip.waitFor({ state: "visible" });
  assert.match(await tooltip.textContent(), /definite replay --kernel collision\/\S+ --distribution \w+ --seed 42 --index \d+/);
  await page.close();
});

test("tables sort, and their data can be taken away", async () => {
  const { page, said } = await open(1280, "light");
  const table = page.locator("table").first();
  const column = async () => (await table.locator("tbody tr td:nth-child(2)").allTextContents()).map(Number);
  const drawn = await column();
  await table.locator("th:nth-child(2) button").click();
  assert.deepEqual(await column(), drawn.toSorted?.((a, b) => a - b) ?? [...drawn].sort((a, b) => a - b));
  assert.equal(await table.locator("th:nth-child(2)").getAttribute("aria-sort"), "ascending");
  await table.locator("th:nth-child(2) button").click();
  assert.deepEqual(await column(), [...drawn].sort((a, b) => b - a));
  const downloading = page.waitForEvent("download");
  await page.locator("#pareto button").click();
  const download = await downloading;
  assert.equal(download.suggestedFilename(), "pareto.csv");
  const lines = readFileSync(await download.path(), "utf8").trim().split("\n");
  assert.match(lines[0], /kernel.*x.*y/);
  assert.ok(lines.length > 6);
  // The command that draws a worst case again has the parameters that the sweep set.
  for (const line of lines.slice(1)) assert.equal(/--index \d+ --set k=2/.test(line), line.includes("--distribution active"), line);
  assert.ok(lines.some((line) => line.includes("--distribution active")));
  assert.deepEqual(said, []);
  await page.close();
});

test("runs of one machine make a history, those of two are refused", async () => {
  const [first, second, other, out] = ["sweep.json", "second.json", "other.json", "history.html"].map((name) => join(folder, name));
  const result = JSON.parse(readFileSync(first, "utf8"));
  for (const row of result.rows) for (const t of row.timing) t.ns_per_hessian.median *= 2;
  writeFileSync(second, JSON.stringify(result));
  writeFileSync(other, JSON.stringify({ ...result, machine: { ...result.machine, cpu: "another" } }));
  const report = (...files) => spawnSync(program, ["report", "--history", ...files, "--out", out], { encoding: "utf8" });
  for (const [files, says] of [[[first, other], /other\.json' is of another machine: its cpu is "another"/], [[first], /two FILEs or more/]]) {
    const done = report(...files);
    assert.equal(done.status, 2);
    assert.match(done.stderr, says);
    assert.ok(!existsSync(out));
  }
  assert.equal(report(first, second).status, 0);
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  const said = [];
  page.on("pageerror", (error) => said.push(error.message));
  await page.goto(`file://${out}`);
  await page.waitForSelector("#history .chart svg");
  // A line with an interval and a point for each of two runs, for each of the six kernels.
  assert.equal(await page.locator("#history .mark-line.role-mark path").count(), 6);
  assert.equal(await page.locator("#history .mark-symbol.role-mark path").count(), 12);
  if (process.env.SCREENSHOTS) await page.screenshot({ path: join(process.env.SCREENSHOTS, "history.png"), fullPage: true });
  assert.deepEqual(said, []);
  await page.close();
});

test("what has no points beside the other choice cannot be chosen", async () => {
  // Operations are counted for analytic alone, and its rounding is taken away.
  const [from, out] = [join(folder, "without.json"), join(folder, "without.html")];
  const result = JSON.parse(readFileSync(join(folder, "sweep.json"), "utf8"));
  for (const row of result.rows) if (row.filter === "analytic") row.accuracy.rounding = null;
  writeFileSync(from, JSON.stringify(result));
  assert.equal(spawnSync(program, ["report", from, join(folder, "speed.json"), "--out", out]).status, 0);
  const page = await browser.newPage();
  await page.goto(`file://${out}`);
  const disabled = (axis, value) => page.locator(`#pareto select[name=${axis}] option[value=${value}]`).isDisabled();
  assert.equal(await disabled("error", "rounding"), false);
  assert.equal(await disabled("cost", "flops"), false);
  await page.selectOption("#pareto select[name=cost]", "flops");
  assert.equal(await disabled("error", "rounding"), true);
  await page.selectOption("#pareto select[name=cost]", "ns");
  await page.selectOption("#pareto select[name=error]", "rounding");
  assert.equal(await disabled("cost", "flops"), true);
  await page.close();
});

test("two files of speed have sections of their own", async () => {
  const out = join(folder, "two.html"), speed = join(folder, "speed.json");
  assert.equal(spawnSync(program, ["report", speed, speed, "--out", out]).status, 0);
  const page = await browser.newPage();
  await page.goto(`file://${out}`);
  await page.waitForSelector("#floors-2 .chart svg");
  const ids = await page.locator("section").evaluateAll((all) => all.map((e) => e.id));
  assert.equal(new Set(ids).size, ids.length, ids.join(" "));
  await page.close();
});

test("an infinite error stands above all others, 0 below", async () => {
  const { points } = await import(join(npm, "src/data.js"));
  const row = (median, p99) => ({ row: {
    timing: [{ pairs: "all", ns_per_hessian: { median: 1, low: 1, high: 1 }, ratio_to: {} }],
    accuracy: { distance: { count: 1, median, p99, max: { value: p99, index: 0 } } } } });
  const [none, some, infinite] = points([row(0, 0), row(1, 2), row(1, "inf")], "ns", "distance");
  assert.ok(none.y < some.y && some.y_high < infinite.y_high);
});

test("what is no result is refused, and nothing is written", () => {
  const out = join(folder, "no.html"), published = join(root, "results/published/shi-kim-2023.json");
  const result = JSON.parse(readFileSync(published, "utf8"));
  for (const [name, content, says] of [
    ["text.json", "hello", "expected a result of definite"],
    ["version.json", JSON.stringify({ ...result, schema: "definite/2" }), "schema definite/1"],
    ["lacking.json", JSON.stringify({ ...result, rows: [{ kernel: "a" }] }), "results/schema.json"],
    ["nothing.json", JSON.stringify({ ...result, rows: [], paper: null }), "nothing to draw"],
    ["none.json", null, "cannot read"],
  ]) {
    if (content !== null) writeFileSync(join(folder, name), content);
    const done = spawnSync(program, ["report", published, join(folder, name), "--out", out], { encoding: "utf8" });
    assert.equal(done.status, 2, done.stderr);
    assert.ok(done.stderr.includes(name) && done.stderr.includes(says), done.stderr);
    assert.ok(!existsSync(out));
  }
});
