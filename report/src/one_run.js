import { chartSection, told } from "./charts.js";
import { element, number, section } from "./elements.js";
import { rankTimes } from "./rank_times.js";
import { idealOf, secondsOf } from "./runs.js";
import { hasMap, subdomainMap } from "./subdomain_map.js";
import { timeChart, workLeft } from "./timeline.js";

const counted = (count, what) => `${number(count)} ${what}${count === 1 ? "" : "s"}`;

function facts(record) {
  const { input = {}, mesh = {}, work = {}, parts = {}, cluster } = record;
  const ideal = idealOf(record);
  const listed = [
    ["input", input.file && `${input.file}: ${counted(input.points, "point")}, ${counted(input.segments, "segment")}, ${counted(input.holes, "hole")}`],
    ["mesh", mesh.triangles && `${counted(mesh.triangles, "triangle")}, ${number(mesh.vertices)} vertices`],
    ["angles", mesh.triangles && `${number(mesh.smallest_angle)} to ${number(mesh.largest_angle)} degrees`],
    ["time", secondsOf(record) !== null && `${number(secondsOf(record))} s of refinement${ideal ? `; ${number(ideal)} s would be ideal` : ""}`],
    ["memory", work.peak_bytes && `${number(Math.round(work.peak_bytes / 1e6))} MB`],
    ["parts", parts.subdomains && `${counted(parts.subdomains, "subdomain")} on ${counted(parts.ranks?.length, "rank")}`],
    ["messages", cluster && `${number(cluster.messages)}, ${number(cluster.message_bytes)} bytes`],
    ["digest", mesh.digest],
  ];
  const rows = listed.filter(([, value]) => value)
    .map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", { class: "text" }, value)));
  return element("div", { class: "scroll" }, element("table", { class: "facts" }, element("tbody", {}, ...rows)));
}

function angles(record) {
  const values = record.mesh.angles_by_10_degrees.map((count, k) => ({ from: 10 * k, to: 10 * (k + 1), count }));
  return chartSection("Angles", "angles", "All three of each triangle.", { data: { values }, height: 200, mark: { type: "bar", color: "#0072b2" }, encoding: {
    x: { field: "from", type: "quantitative", title: "degrees", bin: { binned: true, step: 10 } }, x2: { field: "to" },
    y: { field: "count", type: "quantitative", title: "angles", axis: { format: "~s" } },
    tooltip: [told("from", "from (degrees)"), told("to", "to (degrees)"), told("count", "angles", ",d")] } });
}

/** All about one run. Its charts of time go to `end` seconds, so that runs beside each other can be compared. */
export function oneRun(run, end) {
  const { record, timeline, name } = run;
  const worked = timeline?.busy.length > 0;
  const made = section(`Run ${name}`);
  made.append(facts(record));
  if (record.command) made.append(element("p", { class: "note" }, "To repeat it:"), element("pre", {}, record.command));
  const whole = element("div", { class: "one-run" }, made);
  const parts = [];
  if (worked) parts.push(timeChart(run, end));
  else if (record.cluster) made.append(element("p", { class: "note" }, "There is no timeline: the run's trace was not found beside its record."));
  if (record.parts?.ranks?.length > 0) parts.push(rankTimes(record, end));
  if (worked) parts.push(workLeft(run, end));
  if (hasMap(record)) parts.push(subdomainMap(run));
  if (record.mesh?.angles_by_10_degrees) parts.push(angles(record));
  whole.append(...parts);
  return whole;
}
