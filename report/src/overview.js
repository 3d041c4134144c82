import { element, number, percent } from "./elements.js";
import { rowsOf, sweptKeys } from "./runs.js";

/** A table of all runs. `choose(run)` is called when a reader picks one. */
export function tableOfRuns(runs, choose) {
  const keys = sweptKeys(runs.map((r) => r.record));
  const rows = rowsOf(runs);
  const columns = [["run", (r) => r.name], ...keys.map((key, k) => [key, (r) => r.keys[k]]), ["triangles", (r) => r.triangles],
    ["seconds", (r) => r.seconds], ["times ideal", (r) => (r.ideal ? r.seconds / r.ideal : null)], ["moves", (r) => r.moves],
    ["idle", (r) => percent(r.idle)]].filter(([name, of]) => name === "run" || rows.some((r) => of(r) !== null && of(r) !== ""));
  const words = columns.map(([, of]) => rows.some((r) => typeof of(r) === "string" && !/%$/.test(of(r))));
  const cell = (name, value, k) => element(name, words[k] ? { class: "text" } : {}, typeof value === "string" ? value : number(value));
  const head = element("thead", {}, element("tr", {}, ...columns.map(([name], k) => {
    const made = cell("th", name, k);
    made.scope = "col";
    return made;
  })));
  const body = element("tbody");
  for (const row of rows) {
    const line = element("tr", { tabindex: 0 }, ...columns.map(([, of], k) => cell("td", of(row), k)));
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
  return element("div", { class: "scroll tall" }, element("table", { id: "runs" }, head, body));
}
