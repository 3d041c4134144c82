import { draw } from "./charts.js";
import { element, number, percent, section } from "./elements.js";
import { rowsOf, sweptKeys } from "./runs.js";

/** A table of all runs. `choose(run)` is called when a reader picks one. */
export function tableOfRuns(runs, choose) {
  const keys = sweptKeys(runs.map((r) => r.record));
  const rows = rowsOf(runs);
  const titles = ["run", ...keys, "triangles", "seconds", "times ideal", "moves", "idle"];
  const head = element("thead", {}, element("tr", {}, ...titles.map((t) => element("th", { scope: "col" }, t))));
  const body = element("tbody");
  for (const row of rows) {
    const ratio = row.ideal ? row.seconds / row.ideal : null;
    const cells = [row.name, ...row.keys, row.triangles, row.seconds, ratio, row.moves];
    const shown = cells.map((c) => element("td", {}, typeof c === "string" ? c : number(c)));
    const line = element("tr", { tabindex: 0 }, ...shown, element("td", {}, percent(row.idle)));
    const pick = () => {
      body.querySelectorAll(".chosen").forEach((other) => other.classList.remove("chosen"));
      line.classList.add("chosen");
      choose(row.run);
    };
    line.addEventListener("click", pick);
    line.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") event.preventDefault(), pick();
    });
    body.append(line);
  }
  body.firstChild?.classList.add("chosen");
  return element("div", { class: "scroll" }, element("table", { id: "runs" }, head, body));
}

/** Seconds over the key that was swept last, one color for each combination of the others; mean and range of repetitions. */
export function comparison(runs) {
  const keys = sweptKeys(runs.map((r) => r.record));
  if (keys.length === 0) return null;
  const last = keys.length - 1;
  const values = rowsOf(runs).map((row) => ({ x: row.keys[last], seconds: row.seconds, ideal: row.ideal,
    others: keys.slice(0, last).map((key, k) => `${key} ${row.keys[k]}`).join(", ") }));
  const numeric = values.every((v) => typeof v.x === "number");
  const repeated = runs.some(({ record }) => record.repetition > 0);
  const made = section("Comparison", `${repeated ? "Mean and range over repetitions. " : ""}The short line is the ideal: ` +
    "total work over total speed.");
  const place = element("div", { class: "chart", id: "comparison" });
  made.append(place);
  const x = numeric ? { field: "x", type: "quantitative", title: keys[last] }
    : { field: "x", type: "nominal", title: keys[last], sort: null, axis: { labelAngle: 0 } };
  const color = { field: "others", type: "nominal", title: null, sort: null,
    legend: last > 0 ? { orient: "bottom", columns: 2, labelLimit: 500 } : null };
  const offset = numeric ? {} : { xOffset: { field: "others", sort: null } };
  const y = (field) => ({ field, type: "quantitative", title: "seconds", scale: { zero: true } });
  draw(place, { data: { values }, height: 320, encoding: { x, color, ...offset }, layer: [
    ...(repeated ? [{ mark: { type: "errorbar", extent: "range" }, encoding: { y: y("seconds") } }] : []),
    { mark: { type: "point", filled: true, size: 70, tooltip: true },
      encoding: { y: { ...y("seconds"), aggregate: "mean" } } },
    ...(numeric ? [{ mark: "line", encoding: { y: { ...y("seconds"), aggregate: "mean" } } }] : []),
    { mark: { type: "tick", thickness: 2, width: 14, color: "#000" },
      encoding: { y: { ...y("ideal"), aggregate: "mean" }, color: { value: "#000" } } }] });
  return made;
}
