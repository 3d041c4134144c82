import { draw } from "./charts.js";
import { element, number, section } from "./elements.js";
import { busyIntervals, loadOverTime, movesOf, plansOf, secondsOf } from "./runs.js";

const facts = (record) => {
  const { input = {}, mesh = {}, work = {}, parts = {}, cluster } = record;
  const listed = [
    ["input", `${input.file}: ${number(input.points)} points, ${number(input.segments)} segments, ${number(input.holes)} holes`],
    ["mesh", `${number(mesh.triangles)} triangles, ${number(mesh.vertices)} vertices`],
    ["angles", `${number(mesh.smallest_angle)} to ${number(mesh.largest_angle)} degrees`],
    ["time", `${number(secondsOf(record))} s of refinement`],
    ["memory", work.peak_bytes ? `${number(Math.round(work.peak_bytes / 1e6))} MB` : ""],
    ["parts", parts.subdomains ? `${number(parts.subdomains)} subdomains on ${number(parts.ranks?.length)} ranks` : ""],
    ["messages", cluster ? `${number(cluster.messages)}, ${number(cluster.message_bytes)} bytes` : ""],
    ["digest", mesh.digest ?? ""],
  ];
  const rows = listed.filter(([, value]) => value && !value.startsWith(" "))
    .map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", { class: "text" }, value)));
  return element("table", { id: "facts" }, element("tbody", {}, ...rows));
};

const rankAxis = { title: "rank", type: "ordinal", axis: { labelOverlap: true, tickMinStep: 1 } };

function timeline(record, trace) {
  const busy = busyIntervals(trace);
  const moves = movesOf(record);
  const plans = plansOf(trace);
  const ranks = new Set(busy.map((b) => b.rank));
  const made = section("Timeline", "Blue: the rank refines. Orange: a subdomain moves, from the rank that it leaves to the one that gets it."
    + (plans.length > 0 ? " Triangles: a plan is made or followed; crosses: one is rejected." : ""));
  const place = element("div", { class: "chart", id: "timeline" });
  made.append(place);
  const seconds = (field) => ({ field, type: "quantitative", title: "seconds" });
  draw(place, { height: Math.max(140, Math.min(900, 14 * ranks.size)), layer: [
    { data: { values: busy }, mark: { type: "rect", color: "#0072b2", tooltip: { content: "data" } },
      encoding: { y: { field: "rank", ...rankAxis }, x: seconds("start"), x2: { field: "stop" } } },
    ...(moves.length === 0 ? [] : [{ data: { values: moves }, mark: { type: "rule", color: "#e69f00", opacity: 0.7, tooltip: { content: "data" } },
      encoding: { y: { field: "from", ...rankAxis }, y2: { field: "to" }, x: seconds("left"), x2: { field: "arrived" } } }]),
    ...(plans.length === 0 ? [] : [{ data: { values: plans }, mark: { type: "point", fill: "#ffffff", stroke: "#000000", size: 40, tooltip: { content: "data" } },
      encoding: { y: { field: "rank", ...rankAxis }, x: seconds("time"), shape: { field: "plan", type: "nominal",
        legend: null, scale: { domain: ["made", "rejected"], range: ["triangle-up", "cross"] } } } }])] });
  return made;
}

function load(trace) {
  const values = loadOverTime(trace);
  const made = section("Work left", "Triangles still to be made: between the rank with least and the one with most, and their mean.");
  const place = element("div", { class: "chart", id: "load" });
  made.append(place);
  const time = { field: "time", type: "quantitative", title: "seconds" };
  draw(place, { data: { values }, height: 220, encoding: { x: time }, layer: [
    { mark: { type: "area", color: "#56b4e9", opacity: 0.5 },
      encoding: { y: { field: "least", type: "quantitative", title: "triangles" }, y2: { field: "most" } } },
    { mark: { type: "line", color: "#0072b2", tooltip: true }, encoding: { y: { field: "mean", type: "quantitative" } } }] });
  return made;
}

function angles(record) {
  const bins = record.mesh?.angles_by_10_degrees ?? [];
  const values = bins.map((count, k) => ({ from: 10 * k, to: 10 * (k + 1), count }));
  const made = section("Angles", "Three of each triangle, in steps of ten degrees.");
  const place = element("div", { class: "chart", id: "angles" });
  made.append(place);
  draw(place, { data: { values }, height: 200, mark: { type: "bar", color: "#0072b2", tooltip: true }, encoding: {
    x: { field: "from", type: "quantitative", title: "degrees", bin: { binned: true, step: 10 } }, x2: { field: "to" },
    y: { field: "count", type: "quantitative", title: "angles" } } });
  return made;
}

/** All about one run. */
export function oneRun({ record, trace, name }) {
  const made = section(`Run ${name}`);
  made.append(facts(record));
  if (record.command) made.append(element("p", { class: "note" }, "To repeat it:"), element("pre", {}, record.command));
  const whole = element("div", { id: "one-run" }, made);
  if (busyIntervals(trace).length > 0) whole.append(timeline(record, trace), load(trace));
  if (record.mesh?.angles_by_10_degrees) whole.append(angles(record));
  return whole;
}
