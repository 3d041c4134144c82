import { readMesh, readRuns } from "./data.js";
import { section } from "./elements.js";
import { meshSection } from "./mesh_section.js";
import { oneRun } from "./one_run.js";
import { comparison, tableOfRuns } from "./overview.js";

async function fill(report) {
  const [runs, mesh] = await Promise.all([readRuns(), readMesh()]);
  report.replaceChildren();
  let shown = null;
  let seen = null;
  const choose = (k) => {
    const next = oneRun(runs[k]);
    shown.replaceWith(next);
    shown = next;
    seen?.follow(runs[k].record);
  };
  if (runs.length > 1) {
    const all = section("Runs", "Choose a run to see more of it below.");
    all.append(tableOfRuns(runs, choose));
    report.append(all);
    const compared = comparison(runs);
    if (compared) report.append(compared);
  }
  if (runs.length > 0) report.append((shown = oneRun(runs[0])));
  if (mesh) {
    seen = meshSection(mesh, runs[0]?.record);
    report.append(seen.place);
    seen.start();
  }
  const versions = [...new Set(runs.map((r) => r.record.program))].filter(Boolean);
  document.getElementById("about").textContent =
    `${runs.length} run${runs.length === 1 ? "" : "s"}${versions.length ? `, driftmesh ${versions.join(", ")}` : ""}`;
  document.body.dataset.ready = "yes";
}

const report = document.getElementById("report");
fill(report).catch((error) => {
  report.textContent = `This page cannot be shown: ${error}`;
  throw error;
});
