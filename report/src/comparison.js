import { chartSection, draw, named, told, topLegend } from "./charts.js";
import { element, section } from "./elements.js";
import { rankMeans, rowsOf, sweptKeys } from "./runs.js";
import { timeColor, timeOrder } from "./rank_times.js";

const metrics = {
  "seconds": (row) => row.seconds,
  "times the ideal": (row) => (row.ideal ? row.seconds / row.ideal : null),
  "efficiency": (row) => (row.ideal ? row.ideal / row.seconds : null),
  "idle share of ranks' time": (row) => row.idle,
  "subdomains moved": (row) => row.moves,
  "messages": (row) => row.messages,
  "triangles": (row) => row.triangles,
};

/** The key along the axis: the first numeric one, otherwise the last; the others tell series apart. */
function axisOf(keys, rows) {
  const numeric = keys.findIndex((_, k) => rows.every((row) => typeof row.keys[k] === "number"));
  return { at: numeric >= 0 ? numeric : keys.length - 1, numeric: numeric >= 0 };
}

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;

/** One value for each place on the axis and series: the mean of repetitions and their range. */
function pointsOf(rows, keys, at, metric) {
  const others = keys.map((_, k) => k).filter((k) => k !== at);
  const nameOf = (row) => others.map((k) => (others.length > 1 ? `${keys[k]} ${row.keys[k]}` : row.keys[k])).join(", ");
  const groups = new Map();
  for (const row of rows) {
    const y = metrics[metric](row);
    if (y === null || y === undefined) continue;
    const name = JSON.stringify([row.keys[at], nameOf(row)]);
    if (!groups.has(name)) groups.set(name, { x: row.keys[at], series: nameOf(row), all: [], ideals: [] });
    groups.get(name).all.push(y);
    if (row.ideal) groups.get(name).ideals.push(row.ideal);
  }
  return [...groups.values()].map(({ x, series, all, ideals }) => ({ x, series, y: mean(all), low: Math.min(...all), high: Math.max(...all),
    runs: all.length, ideal: ideals.length > 0 ? mean(ideals) : null }));
}

function specification(rows, keys, metric) {
  const { at, numeric } = axisOf(keys, rows);
  const values = pointsOf(rows, keys, at, metric);
  const series = [...new Set(values.map((v) => v.series))];
  const title = keys.length === 2 ? keys[1 - at] : null;
  const legend = series.length > 1 ? { ...topLegend(), title, ...(numeric && window.innerWidth >= 800 ? { orient: "right", columns: 1 } : {}) } : null;
  const color = { field: "series", type: "nominal", sort: null, legend };
  const value = (field) => ({ field, type: "quantitative", title: metric, scale: { zero: true } });
  const repeated = values.some((v) => v.runs > 1);
  const tooltip = [named("x", keys[at]), ...(series.length > 1 ? [named("series", title ?? "series")] : []), told("y", metric),
    ...(repeated ? [told("low", "least"), told("high", "most"), told("runs", "repetitions", ",d")] : [])];
  const point = { type: "point", filled: true, size: 70, opacity: 1 };
  const showsIdeal = metric === "seconds" && values.some((v) => v.ideal);
  if (numeric) {
    const xs = [...new Set(values.map((v) => v.x))];
    const logarithmic = Math.min(...xs) > 0 && Math.max(...xs) >= 8 * Math.min(...xs);
    const x = { field: "x", type: "quantitative", title: keys[at], scale: logarithmic ? { type: "log", base: 2, nice: false } : { zero: false },
      axis: { values: xs, format: "~g", labelOverlap: true, grid: false } };
    return { data: { values }, height: 320, encoding: { x }, layer: [
      ...(repeated ? [{ mark: { type: "rule", strokeWidth: 2 }, encoding: { y: value("low"), y2: { field: "high" }, stroke: { ...color, legend: null } } }] : []),
      { mark: "line", encoding: { y: value("y"), stroke: { ...color, legend: null } } },
      { mark: point, encoding: { y: value("y"), color, shape: color, tooltip } },
      ...(showsIdeal ? [{ mark: { type: "line", strokeDash: [5, 4], color: "#555" }, encoding: { y: { ...value("ideal"), aggregate: "mean" } } }] : [])] };
  }
  const y = { field: "x", type: "nominal", sort: null, title: keys[at], axis: { labelLimit: 300 } };
  const offset = series.length > 1 ? { yOffset: { field: "series", sort: null } } : {};
  const height = new Set(values.map((v) => v.x)).size * Math.max(16 * series.length, 34);
  return { data: { values }, height, encoding: { y, ...offset }, layer: [
    { mark: { type: "bar", opacity: 0.2, cornerRadiusEnd: 2 }, encoding: { x: { ...value("y"), stack: null }, fill: { ...color, legend: null } } },
    ...(repeated ? [{ mark: { type: "rule", strokeWidth: 2 }, encoding: { x: value("low"), x2: { field: "high" }, stroke: { ...color, legend: null } } }] : []),
    { mark: point, encoding: { x: value("y"), color, shape: color, tooltip } },
    { mark: { type: "text", align: "left", dx: 9, color: "#333" }, encoding: { x: value(repeated ? "high" : "y"), text: { field: "y", format: ",.4~g" } } },
    ...(showsIdeal ? [{ mark: { type: "tick", thickness: 2, color: "#000", ...(series.length > 1 ? { size: 13 } : {}) }, encoding: { x: value("ideal") } }] : [])] };
}

/** Runs over what was swept: a section with a choice of what is compared. Null if nothing was. */
export function comparison(runs) {
  const keys = sweptKeys(runs.map((r) => r.record));
  if (keys.length === 0) return null;
  const rows = rowsOf(runs);
  const offered = Object.keys(metrics).filter((m) => rows.some((row) => metrics[m](row) !== null && metrics[m](row) !== undefined));
  const choice = element("select", { id: "metric" }, ...offered.map((m) => element("option", {}, m)));
  const repeated = runs.some(({ record }) => record.repetition > 0);
  const note = `${repeated ? "Mean and range of repetitions. " : ""}`
    + (rows.some((row) => row.ideal) ? "Black or dashed: the ideal, total work over total speed." : "");
  const made = section("Comparison", note);
  const place = element("div", { class: "chart", id: "comparison" });
  const show = () => draw(place, specification(rows, keys, choice.value));
  choice.addEventListener("change", show);
  made.append(element("div", { class: "controls" }, element("label", {}, "Compare: ", choice)), place);
  show();
  return made;
}

const kMostBars = 80;

/** What the ranks of each run spent their time on, in the mean. Null without ranks. */
export function timesOfRuns(runs) {
  const keys = sweptKeys(runs.map((r) => r.record));
  const rows = rowsOf(runs);
  const values = runs.flatMap(({ record, name }, k) => rankMeans(record).map(({ kind, seconds }, order) =>
    ({ run: [name, ...rows[k].keys].join("  "), kind, order, seconds })));
  if (values.length === 0 || runs.length > kMostBars) return null;
  const title = ["run", ...keys].join(", ");
  return chartSection("Where time goes", "times", "Mean of all ranks.", { data: { values }, height: 20 * runs.length, mark: { type: "bar" }, encoding: {
    y: { field: "run", type: "nominal", sort: null, title: null, axis: { labelLimit: 320, domain: false, ticks: false } },
    x: { field: "seconds", type: "quantitative", title: "seconds", stack: "zero" }, color: timeColor, order: timeOrder,
    tooltip: [named("run", title), named("kind", "time"), told("seconds", "seconds")] } });
}
