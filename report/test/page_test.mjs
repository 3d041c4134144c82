// A report in a browser without a window: what it shows, and what it does when it is used.
//   node page_test.mjs DRIFTMESH BROWSER FOLDER [PACKAGES]
// The pictures that it leaves in FOLDER are for looking at. PACKAGES: the folder of node_modules, if not above this file.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [program, browserPath, folder, packages = "."] = process.argv.slice(2);
const require = createRequire(resolve(packages, "package.json"));
const { default: puppeteer } = await import(pathToFileURL(require.resolve("puppeteer-core")));

const kSize = "x < 0.45 && y < 0.45 ? 0.01 : 0.05";
const kRanks = 4, kSubdomains = 40;
const file = (name) => join(folder, name);
const driftmesh = (...words) => execFileSync(program, words, { stdio: ["ignore", "pipe", "inherit"], encoding: "utf8" });

/** Runs of three policies, and the mesh that all of them make. */
function makeReport() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const set = { "input.generate": "rectangle-hole", "sizing.size": kSize, "decomposition.subdomains": kSubdomains,
    "cluster.kind": "simulated", "cluster.ranks": kRanks, "cluster.speed": 1e5, "mapping.by-area": true, "balance.look": 1e-3,
    "balance.gap": 2e-3 };
  const words = Object.entries(set).flatMap(([key, value]) => ["--set", `${key}=${value}`]);
  driftmesh("run", "--quiet", fileOfSweep(), ...words, "-o", file("runs"));
  driftmesh("generate", "rectangle-hole", "-o", file("domain.poly"));
  driftmesh("mesh", "--quiet", file("domain.poly"), "--size", kSize, "--subdomains", String(kSubdomains), "--save-size-tree", file("mesh.tree"),
    "-o", file("mesh.vtu"));
  driftmesh("report", file("runs"), "--mesh", file("mesh.vtu"), "--size-tree", file("mesh.tree"), "-o", file("report.html"));
}

/** Two meshes of a square, at three times, with values at the points that are the same everywhere at the last one. */
function makeSeries() {
  const sets = [[0, 4], [0.5, 4], [2, 9]].map(([time, cells], k) => {
    writeFileSync(file(`u_${k}.vtu`), frameOf(cells, (x, y) => (k < 2 ? k + x - y : 1)));
    return `<DataSet timestep="${time}" file="u_${k}.vtu"/>`;
  });
  writeFileSync(file("u.pvd"), `<VTKFile type="Collection"><Collection>${sets.join("")}</Collection></VTKFile>`);
  driftmesh("report", file("u.pvd"), "--field", "u", "-o", file("series.html"));
  const fields = { flat: (x, y) => 7 + 4e-7 * ((x * 97 + y * 31) % 1), lost: (x) => (x > 0.5 ? "nan" : "inf") };
  for (const [name, u] of Object.entries(fields)) {
    writeFileSync(file(`${name}.vtu`), frameOf(9, u));
    driftmesh("report", file(`${name}.vtu`), "--field", "u", "-o", file(`${name}.html`));
  }
}

function frameOf(cells, u) {
  const side = [...Array(cells + 1).keys()], inner = side.slice(1);
  const points = side.flatMap((j) => side.map((i) => [i / cells, j / cells]));
  const at = (i, j) => j * (cells + 1) + i;
  const triangles = inner.flatMap((j) => inner.flatMap((i) => [[at(i - 1, j - 1), at(i, j - 1), at(i, j)], [at(i - 1, j - 1), at(i, j), at(i - 1, j)]]));
  const array = (type, name, values, components = 1) =>
    `<DataArray type="${type}" Name="${name}" NumberOfComponents="${components}" format="ascii">${values.flat().join(" ")}</DataArray>`;
  return `<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>
<Piece NumberOfPoints="${points.length}" NumberOfCells="${triangles.length}"><PointData>${array("Float64", "u", points.map(([x, y]) => u(x, y)))}</PointData>
<CellData></CellData><Points>${array("Float64", "Points", points.map((p) => [...p, 0]), 3)}</Points>
<Cells>${array("Int64", "connectivity", triangles)}${array("Int64", "offsets", triangles.map((_, k) => 3 * k + 3))}
${array("UInt8", "types", triangles.map(() => 5))}</Cells></Piece></UnstructuredGrid></VTKFile>`;
}

function fileOfSweep() {
  const path = file("sweep.yaml");
  writeFileSync(path, "sweep:\n  balance.policy: [none, greedy, stealing]\n");
  return path;
}

const wait = (page, condition, ...values) => page.waitForFunction(condition, { timeout: 120000 }, ...values);
const text = (page, selector) => page.$eval(selector, (e) => e.textContent);
/** How many pixels of a canvas are not white. */
const inked = (page, selector) => page.$eval(selector, (canvas) => {
  const copy = document.createElement("canvas");
  copy.width = canvas.width, copy.height = canvas.height;
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 0 && data[i] + data[i + 1] + data[i + 2] < 750) ++count;
  return count;
});

async function checkRuns(page) {
  assert.equal((await page.$$("#runs tbody tr")).length, 3);
  assert.match(await text(page, "#about"), /^A report by driftmesh \d[.\d]*, 3 runs, [\d,]+ triangles$/);
  const records = [1, 2, 3].map((k) => JSON.parse(readFileSync(file(`runs/run-${k}.json`), "utf8")));
  const moves = await page.$$eval("#runs tbody tr", (rows) => rows.map((r) => Number(r.cells[5].textContent.replaceAll(",", ""))));
  assert.deepEqual(moves, records.map((r) => r.cluster.moves.length));
  assert.ok(moves[1] > 0, "greedy moves something, or this test shows nothing");
  const charts = ["#comparison", ".times", ".timeline", ".rank-times", ".load", ".angles", ".areas", ".smallest-angles"];
  for (const chart of [...charts.map((c) => `${c} canvas`), ".map"]) {
    await wait(page, (selector) => document.querySelector(selector), chart);
    assert.ok((await inked(page, chart)) > 500, `${chart} is drawn`);
  }
  // Another figure is compared.
  const drawn = await page.$eval("#comparison canvas", (canvas) => canvas.toDataURL());
  await page.select("#metric", "subdomains moved");
  await wait(page, (before) => (document.querySelector("#comparison canvas")?.toDataURL() ?? before) !== before, drawn);
  // By keyboard, as by mouse, a reader gets to another run.
  await page.focus("#runs tbody tr:nth-child(2)");
  await page.keyboard.press("Enter");
  await wait(page, () => document.querySelector(".one-run h2").textContent === "Run run-2");
  assert.ok((await text(page, ".facts")).includes(records[1].mesh.digest));
  await page.click("#runs tbody tr:nth-child(3)");
  await wait(page, () => document.querySelector(".one-run h2").textContent === "Run run-3");
  await page.select("#beside", "1");
  await wait(page, () => document.querySelectorAll(".timeline canvas").length === 2);
  assert.deepEqual(await page.$$eval(".one-run > section:first-child h2", (titles) => titles.map((t) => t.textContent)), ["Run run-3", "Run run-2"]);
  await page.select("#beside", "");
  await checkTimeline(page);
  await checkMap(page);
}

/** Moves the slider of a replay: all its frames would take long where there are no graphics. */
const nearlyTheEnd = (page, id) => page.$eval(`[id='${id}']`, (slider) => {
  slider.value = 0.9;
  slider.dispatchEvent(new Event("input"));
});

/** Ctrl and the wheel show less time, a double click all of it. */
async function checkTimeline(page) {
  await wait(page, () => document.querySelectorAll(".timeline canvas").length === 1);
  await page.$eval(".timeline", (chart) => chart.scrollIntoView({ block: "center" }));
  const { x, y, width, height } = await (await page.$(".timeline canvas")).boundingBox();
  const picture = () => page.$eval(".timeline canvas", (canvas) => canvas.toDataURL());
  const changed = (before) => wait(page, (was) => document.querySelector(".timeline canvas").toDataURL() !== was, before);
  const whole = await picture();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.keyboard.down("Control");
  await page.mouse.wheel({ deltaY: -300 });
  await page.keyboard.up("Control");
  await changed(whole);
  const part = await picture();
  await page.mouse.click(x + width / 2, y + height / 2, { clickCount: 2 });
  await changed(part);
}

/** Subdomains have the colors of other ranks at the end. */
async function checkMap(page) {
  const picture = () => page.$eval(".map", (canvas) => canvas.toDataURL());
  const before = await picture();
  await nearlyTheEnd(page, "run-3-time");
  await page.click("[id='run-3-play']");
  await wait(page, () => Number(document.getElementById("run-3-time").value) === 1);
  assert.notEqual(await picture(), before);
  await page.$eval(".map", (canvas) => canvas.scrollIntoView({ block: "center" }));
  const { x, y, width, height } = await (await page.$(".map")).boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await wait(page, () => /^Subdomain \d+ on rank \d/.test(document.querySelector(".one-run .told").textContent));
}

async function checkMesh(page) {
  const all = await inked(page, "#mesh");
  assert.ok(all > 10000, `the mesh is drawn: ${all} pixels`);
  const drawn = () => page.$eval("#mesh", (canvas) => Number(canvas.dataset.drawn));
  // The middle of the rectangle is its hole; a place near its lower left corner is not.
  await page.$eval("#mesh", (canvas) => canvas.scrollIntoView({ block: "center" }));
  const { x, y, width, height } = await (await page.$("#mesh")).boundingBox();
  await page.mouse.move(x + width / 8, y + (3 * height) / 4);
  await wait(page, () => /^triangle [\d,]+ at \(.*\), area/.test(document.getElementById("told").textContent));
  assert.match(await text(page, "#told"), /subdomain \d+/);
  const [, edge, size] = /longest edge ([\d.]+) where ([\d.]+) is asked for/.exec(await text(page, "#told")).map(Number);
  assert.ok(size === 0.01 && edge > 0.002 && edge <= 1.25 * size, `${edge} where ${size} is asked for, 0.01 by ${kSize}`);
  await page.mouse.move(x + 3, y + 3);
  await wait(page, () => document.getElementById("told").textContent === "");
  // Zoom by keyboard and by wheel, and back.
  await page.focus("#mesh");
  await page.keyboard.press("+");
  await wait(page, () => Number(document.getElementById("mesh").dataset.zoom) > 1.4);
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.wheel({ deltaY: -400 });
  await wait(page, () => Number(document.getElementById("mesh").dataset.zoom) > 2);
  await page.screenshot({ path: file("zoomed.png") });
  const before = await drawn();
  await page.mouse.move(x + width / 8, y + (3 * height) / 4);  // not in the hole
  for (let k = 0; k < 6; ++k) await page.mouse.wheel({ deltaY: -400 });
  await wait(page, (most) => Number(document.getElementById("mesh").dataset.drawn) < most, before / 2);
  assert.ok((await drawn()) > 0 && (await inked(page, "#mesh")) > 10000, "what is in sight is drawn, and no more");
  await page.keyboard.press("0");
  await wait(page, () => document.getElementById("mesh").dataset.zoom === "1.000");
}

/** Each scale and category has its colors and its legend; sizes are as they were asked for. */
async function checkColors(page) {
  const seen = new Set();
  for (const [name, legend] of [["area", "area"], ["angle", "smallest angle"], ["size", /length asked for 0\.010*.*0\.050*$/], ["edge to size", "longest edge"],
    ["subdomain", "0"], ["rank", "0"]]) {
    if (!(await page.$$eval("#color-by option", (all, value) => all.some((o) => o.value === value), name))) {
      assert.equal(name, "rank", `the page offers ${name}`);
      continue;
    }
    await page.select("#color-by", name);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.match(await text(page, "#legend"), new RegExp(legend));
    seen.add(await page.$eval("#mesh", (canvas) => canvas.toDataURL()));
    if (name === "size" || name === "edge to size") await page.screenshot({ path: file(`${name.replaceAll(" ", "-")}.png`) });
  }
  assert.ok(seen.size >= 5, "no two look alike");
}

/** Other ranks have other colors at the end than at the beginning. */
async function checkReplay(page) {
  await page.select("#color-by", "rank over time");
  const colors = () => page.$eval("#mesh", (canvas) => canvas.toDataURL());
  await page.evaluate(() => new Promise(requestAnimationFrame));
  const before = await colors();
  await nearlyTheEnd(page, "time");
  await page.click("#play");
  await wait(page, () => Number(document.getElementById("time").value) === 1);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.notEqual(await colors(), before);
}

/** How many there are in the middle of a canvas. */
const colorsIn = (page, canvas) => page.$eval(canvas, (shown) => {
  const copy = document.createElement("canvas");
  copy.width = shown.width, copy.height = shown.height;
  const context = copy.getContext("2d");
  context.drawImage(shown, 0, 0);
  const { data } = context.getImageData(shown.width / 4, shown.height / 4, shown.width / 2, shown.height / 2);
  return new Set(new Uint32Array(data.buffer)).size;
});

/** What is the same everywhere but for rounding has one color, and so has what is no number. */
async function checkFlat(page) {
  for (const [name, legend] of [["flat", "u7"], ["lost", "u: no value is a finite number"]]) {
    await page.goto(pathToFileURL(resolve(file(`${name}.html`))).href, { timeout: 120000 });
    await page.waitForSelector("body[data-ready=yes]", { timeout: 120000 });
    assert.equal(await text(page, "#series-legend"), legend);
    await page.click("#series-edges");
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.equal(await colorsIn(page, "#series"), 1, name);
  }
}

/** Frames are played, stepped through by keyboard, and pointed at, with the same colors for the same values. */
async function checkSeries(page) {
  await page.goto(pathToFileURL(resolve(file("series.html"))).href, { timeout: 120000 });
  await page.waitForSelector("body[data-ready=yes]", { timeout: 120000 });
  assert.equal(await text(page, "#about"), "A report by driftmesh, 3 frames");
  assert.equal(await text(page, "#series-legend"), "u -12");
  const atFrame = async (k, words) => {
    await wait(page, (wanted) => document.getElementById("series").dataset.frame === wanted, String(k));
    assert.equal(await text(page, "#series-clock"), words);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    return page.$eval("#series", (canvas) => canvas.toDataURL());
  };
  const words = ["Frame 1 of 3, time 0, 32 triangles", "Frame 2 of 3, time 0.5, 32 triangles", "Frame 3 of 3, time 2, 162 triangles"];
  const first = await atFrame(0, words[0]);
  await page.focus("#series");
  await page.keyboard.press(".");
  assert.notEqual(await atFrame(1, words[1]), first);
  await page.keyboard.press("End");
  const last = await atFrame(2, words[2]);
  await page.screenshot({ path: file("series.png") });
  await page.keyboard.press("e");
  assert.equal(await page.$eval("#series-edges", (box) => box.checked), false);
  assert.notEqual(await atFrame(2, words[2]), last);
  assert.equal(await colorsIn(page, "#series"), 1, "without edges one value has one color");
  await page.keyboard.press(" ");
  await atFrame(2, words[2]);
  await wait(page, () => document.getElementById("series-play").textContent === "Play");
  assert.equal(await page.$eval("#series-time", (slider) => slider.value), "2");
  await page.keyboard.press("Home");
  await atFrame(0, words[0]);
  await page.keyboard.press(",");
  await atFrame(0, words[0]);
  const { x, y, width, height } = await (await page.$("#series")).boundingBox();
  await page.mouse.move(x + width / 2 + 5, y + height / 2 + 5);
  await wait(page, () => /^u 0\.0\d* at \(0\.5\d*, 0\.4\d*\), triangle \d+, area 0\.03125$/.test(document.getElementById("series-told").textContent));
  await page.click("#series-play");
  await atFrame(2, words[2]);
  assert.equal(await text(page, "#series-told"), "");
}

makeReport();
makeSeries();
const browser = await puppeteer.launch({ executablePath: browserPath, headless: true,
  args: ["--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 1000 });
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => ["error", "warning", "warn"].includes(message.type()) && problems.push(message.text()));
  page.on("request", (request) => /^https?:/.test(request.url()) && problems.push(`asks for ${request.url()}`));
  await page.goto(pathToFileURL(resolve(file("report.html"))).href, { timeout: 120000 });
  await page.waitForSelector("body[data-ready=yes]", { timeout: 120000 });
  await checkRuns(page);
  await checkMesh(page);
  await checkColors(page);
  await checkReplay(page);
  await page.screenshot({ path: file("report.png"), fullPage: true });
  await page.pdf({ path: file("report.pdf"), format: "A4", printBackground: true });
  await page.setViewport({ width: 390, height: 844 });
  await page.evaluate(() => new Promise((done) => setTimeout(done, 500)));
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390), "a phone shows it without scrolling sideways");
  await page.screenshot({ path: file("phone.png"), fullPage: true });
  await page.setViewport({ width: 1280, height: 1000 });
  await checkSeries(page);
  await checkFlat(page);
  assert.deepEqual(problems, []);
} finally {
  await browser.close();
}
console.log("the page does what it should");
