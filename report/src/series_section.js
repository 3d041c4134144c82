import { element, number, section } from "./elements.js";
import { valuesLegend } from "./legends.js";
import { meshCanvas } from "./mesh_canvas.js";
import { sortTriangles } from "./mesh_levels.js";
import { endsOfScale, intoSquare, measure, valueAt } from "./mesh_values.js";
import { player } from "./replay.js";

const kDelay = 100;  // milliseconds from one frame to the next
const kKept = 4e6;   // triangles of meshes that are kept as they are drawn

/** The meshes as they are drawn, each made when it is first asked for; those that were not for the longest time go. */
function drawnMeshes(series) {
  const kept = new Map();
  const make = async (k) => {
    const { points, triangles } = await series.mesh(k);
    const { length, middle, half } = intoSquare(points, series.box);
    const sorted = sortTriangles(points, triangles);
    return { ...sorted, points, length, half, middle: middle.map((x, d) => x + series.middle[d]), areas: measure(points, sorted.triangles).areas };
  };
  return async (k) => {
    const mesh = kept.get(k) ?? await make(k);
    kept.delete(k);
    kept.set(k, mesh);
    let triangles = [...kept.values()].reduce((sum, { order }) => sum + order.length, 0);
    for (const [oldest, { order }] of kept) {
      if (triangles <= kKept || oldest === k) break;
      kept.delete(oldest);
      triangles -= order.length;
    }
    return mesh;
  };
}

/** Frames of one field, played: {place, start()}. start() once the place is in the page; what it promises is the first frame. */
export function seriesSection(series) {
  const { frames, field, range } = series;
  const last = frames.length - 1;
  const place = section(`${field} of ${series.name}`, "Space plays, comma and period go to the frame before and after, Home and End to the first and the "
    + "last, E shows edges. Drag or arrow keys move, the wheel or + and - zoom, 0 shows all.");
  const clock = element("span", { class: "note clock", id: "series-clock" });
  const edges = element("input", { type: "checkbox", id: "series-edges", checked: "" });
  const meshes = drawnMeshes(series);
  let mesh = null, values = null, asked = 0;

  const describe = (t, at) => {
    const [x, y] = at.map((c, d) => number(mesh.middle[d] + c * mesh.length, 7));
    const value = series.atPoints ? valueAt(mesh, values, t, at) : values[t];
    return `${field} ${Number.isNaN(value) ? "is not a number" : number(value, 6)} at (${x}, ${y}), triangle ${number(mesh.order[t])}, area `
      + `${number(mesh.areas[t] * mesh.length ** 2)}`;
  };
  const shown = meshCanvas({ canvasId: "series", saidId: "series-told", label: `${field}, as colors` }, describe);

  const show = async (k) => {
    const turn = ++asked;
    const [next, found] = await Promise.all([meshes(frames[k].mesh), series.values(k)]);
    if (turn !== asked) return;
    const view = shown.view();
    values = series.atPoints ? found : Float32Array.from(next.order, (t) => found[t]);
    if (!view && !shown.begin(next)) return;
    if (view && next !== mesh) view.show(next);
    mesh = next;
    shown.view().marked = -1;
    shown.view().byValues(values, endsOfScale(range), series.atPoints);
    const { time } = frames[k];
    clock.textContent = `Frame ${number(k + 1)} of ${number(last + 1)}${time === null ? "" : `, time ${number(time, 6)}`}, `
      + `${number(mesh.order.length)} triangles`;
    shown.canvas.dataset.frame = k;
    shown.said.textContent = "";
    shown.redraw();
  };
  const controls = player("series-", "Frame", { last, step: 1, grid: 1 }, () =>
    Promise.all([show(controls.position()), new Promise((done) => setTimeout(done, kDelay))]));
  if (last === 0) controls.place.style.display = "none";

  edges.addEventListener("change", () => {
    if (!shown.view()) return;
    shown.view().edges = edges.checked;
    shown.redraw();
  });
  const by = (step) => () => {
    controls.stop();
    controls.to(controls.position() + step);
  };
  const keys = { " ": controls.toggle, ",": by(-1), ".": by(1), Home: by(-Infinity), End: by(Infinity), e: () => edges.click() };
  place.addEventListener("keydown", (event) => {
    const { key, target } = event;
    const does = keys[key] ?? keys[key.toLowerCase()];
    const isOfTarget = target.matches("input, button") && [" ", "Home", "End"].includes(key);
    if (!does || isOfTarget || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    does();
  });
  place.append(element("div", { class: "controls" }, controls.place, clock, element("label", {}, edges, " Edges"),
    element("span", { class: "legend", id: "series-legend" }, ...valuesLegend(range, field))),
  element("div", { class: "mesh" }, shown.canvas), shown.said);
  return { place, start: () => show(0) };
}
