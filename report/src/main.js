import { comparison, timesOfRuns } from "./comparison.js";
import { readMesh, readRuns, readSeries } from "./data.js";
import { element, number, section } from "./elements.js";
import { meshSection } from "./mesh_section.js";
import { oneRun } from "./one_run.js";
import { tableOfRuns } from "./overview.js";
import { secondsOf } from "./runs.js";
import { seriesSection } from "./series_section.js";

/** The chosen run, and beside it another one if a reader wants that: {place, choose(k)}. */
function chosenRun(runs, follow) {
  const place = element("div", { id: "chosen" });
  const beside = element("select", { id: "beside" }, element("option", { value: "" }, "no other run"),
    ...runs.map(({ name }, k) => element("option", { value: k }, name)));
  let chosen = 0;
  const show = () => {
    const shown = [runs[chosen], ...(beside.value === "" ? [] : [runs[beside.value]])];
    const end = Math.max(...shown.map(({ record }) => secondsOf(record) ?? 0));
    place.replaceChildren(element("div", { class: shown.length > 1 ? "beside" : "" }, ...shown.map((run) => oneRun(run, end))));
    if (runs.length > 1) place.prepend(element("div", { class: "controls" }, element("label", {}, "Beside the chosen run: ", beside)));
  };
  beside.addEventListener("change", show);
  const choose = (k) => {
    chosen = k;
    show();
    follow(runs[k].record);
  };
  return { place, show, choose };
}

function titleOf(runs, mesh, series) {
  const names = [...new Set(runs.map(({ record }) => record.experiment?.name))].filter(Boolean);
  if (names.length > 0) return names.join(", ");
  return mesh?.name ?? series?.name ?? (runs.length === 1 ? runs[0].record.input?.file : null) ?? "driftmesh report";
}

function aboutOf(runs, mesh, series) {
  const versions = [...new Set(runs.map((r) => r.record.program))].filter(Boolean);
  return [`A report by driftmesh ${versions.join(" and ")}`.trim(), ...(runs.length > 0 ? [`${runs.length} run${runs.length === 1 ? "" : "s"}`] : []),
    ...(mesh ? [`${number(mesh.triangles.length / 3)} triangles`] : []),
    ...(series ? [`${number(series.frames.length)} frame${series.frames.length === 1 ? "" : "s"}`] : [])].join(", ");
}

async function fill(report) {
  const [runs, mesh] = await Promise.all([readRuns(), readMesh()]);
  const series = readSeries();
  const title = titleOf(runs, mesh, series);
  document.title = title;
  document.querySelector("h1").textContent = title;
  document.getElementById("about").textContent = aboutOf(runs, mesh, series);
  report.replaceChildren();
  let seen = null;
  const chosen = chosenRun(runs, (record) => seen?.follow(record));
  if (runs.length > 1) {
    const all = section("Runs", "Choose a run to see more of it below.");
    all.append(tableOfRuns(runs, chosen.choose));
    report.append(all, ...[comparison(runs), timesOfRuns(runs)].filter(Boolean));
  }
  if (mesh) {
    seen = meshSection(mesh, runs[0]?.record);
    report.append(seen.place);
    seen.start();
  }
  if (series) {
    const played = seriesSection(series);
    report.append(played.place);
    await played.start();
  }
  if (runs.length > 0) {
    report.append(chosen.place);
    chosen.show();
  }
  document.body.dataset.ready = "yes";
}

const report = document.getElementById("report");
fill(report).catch((error) => {
  report.textContent = `This page cannot be shown: ${error}`;
  throw error;
});
