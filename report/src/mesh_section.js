import { select } from "d3-selection";
import { zoom, zoomIdentity } from "d3-zoom";
import { element, number, section } from "./elements.js";
import { draw } from "./charts.js";
import { MeshView, modes, stops } from "./mesh_view.js";
import { movesOf, ownersAt, secondsOf } from "./runs.js";

/** Into a square of side 2 around 0, as the view wants it. */
function centered(points) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 2)
    for (const d of [0, 1]) {
      low[d] = Math.min(low[d], points[i + d]);
      high[d] = Math.max(high[d], points[i + d]);
    }
  const half = Math.max(high[0] - low[0], high[1] - low[1]) / 2 || 1;
  const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return points.map((x, i) => (x - middle[i % 2]) / half);
}

const corners = ({ points, triangles }, t) =>
  [0, 1, 2].map((k) => [points[2 * triangles[3 * t + k]], points[2 * triangles[3 * t + k] + 1]]);

function areaOf(mesh, t) {
  const [[ax, ay], [bx, by], [cx, cy]] = corners(mesh, t);
  return Math.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2;
}

function smallestAngle(mesh, t) {
  const p = corners(mesh, t);
  const angle = (o, a, b) => {
    const ux = a[0] - o[0], uy = a[1] - o[1], vx = b[0] - o[0], vy = b[1] - o[1];
    return (Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180) / Math.PI;
  };
  return Math.min(angle(p[0], p[1], p[2]), angle(p[1], p[2], p[0]), angle(p[2], p[0], p[1]));
}

/** The logarithms of the least and the greatest of the areas. */
function logarithmicRange(areas) {
  let least = Infinity, greatest = 0;
  for (const area of areas) {
    if (area > 0) least = Math.min(least, area);
    greatest = Math.max(greatest, area);
  }
  return [Math.log(least), Math.log(greatest)];
}

/** How many areas there are in each of some intervals of equal ratio. */
function histogram(areas, [low, high], bins = 40) {
  const width = (high - low) / bins || 1;
  const counts = new Array(bins).fill(0);
  for (const area of areas) if (area > 0) ++counts[Math.min(bins - 1, Math.floor((Math.log(area) - low) / width))];
  return counts.map((count, k) => ({ from: Math.exp(low + k * width), to: Math.exp(low + (k + 1) * width), count }));
}

function chartOfAreas(areas, range) {
  const made = section("Areas", "Triangles by area, in intervals of equal ratio.");
  const place = element("div", { class: "chart", id: "areas" });
  made.append(place);
  const x = { field: "from", type: "quantitative", title: "area", scale: { type: "log", nice: false } };
  draw(place, { data: { values: histogram(areas, range) }, height: 200, mark: { type: "rect", color: "#0072b2", tooltip: true },
    encoding: { x, x2: { field: "to" }, y: { field: "count", type: "quantitative", title: "triangles" }, y2: { datum: 0 } } });
  return made;
}

/** A strip of the colors from the least to the greatest value. */
function legend(least, greatest) {
  const colors = stops.map((s) => `rgb(${s.map((c) => Math.round(255 * c)).join(",")})`).join(",");
  const strip = element("span", { class: "strip", style: `background: linear-gradient(to right, ${colors})` });
  return [number(least), strip, number(greatest)];
}

function describe(mesh, t) {
  const parts = [`triangle ${number(t)}`, `area ${number(areaOf(mesh, t))}`, `smallest angle ${number(smallestAngle(mesh, t))} degrees`];
  for (const [name, column] of Object.entries(mesh.columns)) parts.push(`${name} ${column[t]}`);
  return parts.join(", ");
}

/** The mesh with its controls: {place, start(), follow(record)}. start() once the place is in the page. */
export function meshSection(mesh, firstRecord) {
  let record = firstRecord;
  const place = section(`Mesh ${mesh.name}`,
    `${number(mesh.triangles.length / 3)} triangles. Drag or arrow keys move, the wheel or + and - zoom, 0 shows all.`);
  const canvas = element("canvas", { tabindex: 0, role: "img", "aria-label": "The mesh", id: "mesh" });
  const colorBy = element("select", { id: "color-by" });
  const time = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0, id: "time", "aria-label": "Time" });
  const play = element("button", { type: "button", id: "play" }, "Play");
  const clock = element("span", { class: "note", id: "clock" });
  const replay = element("span", { class: "controls" }, play, time, clock);
  const key = element("span", { class: "legend", id: "legend" });
  const told = element("p", { id: "told", "aria-live": "polite" });
  place.append(element("div", { class: "controls" }, element("label", {}, "Color: ", colorBy), key, replay),
    element("div", { class: "mesh" }, canvas), told);

  const shown = { ...mesh, points: centered(mesh.points) };
  const areas = Float64Array.from({ length: mesh.triangles.length / 3 }, (_, t) => areaOf(mesh, t));
  const range = logarithmicRange(areas);
  place.append(chartOfAreas(areas, range));
  let view = null, waiting = false;
  const redraw = () => {
    if (waiting || !view) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      view.resize();
      view.draw();
    });
  };

  const hasOwners = () => mesh.columns.subdomain && record?.cluster?.owners_before && movesOf(record).length > 0 &&
    mesh.columns.subdomain.reduce((a, b) => Math.max(a, b), 0) < record.cluster.owners_before.length;
  const offer = () => {
    const before = colorBy.value;
    const names = ["angle", "area", ...Object.keys(mesh.columns), ...(hasOwners() ? ["rank over time"] : [])];
    colorBy.replaceChildren(...names.map((name) => element("option", {}, name)));
    colorBy.value = names.includes(before) ? before : mesh.columns.rank ? "rank" : "area";
  };
  const paint = () => {
    const by = colorBy.value;
    replay.style.display = by === "rank over time" ? "" : "none";
    key.replaceChildren(...(by === "angle" ? [...legend(0, 60), "degrees, the smallest of a triangle"] : []),
      ...(by === "area" ? legend(...range.map(Math.exp)) : []));
    if (by === "angle") view.mode = modes.angle;
    else if (by === "area") view.mode = modes.area;
    else if (by !== "rank over time") view.setNumbers(Uint32Array.from(mesh.columns[by]));
    else {
      const now = time.value * secondsOf(record);
      clock.textContent = `${number(now)} s`;
      const owners = ownersAt(record, now);
      view.setNumbers(Uint32Array.from(mesh.columns.subdomain, (s) => owners[s]));
    }
    redraw();
  };
  const step = () => {
    if (play.textContent === "Play") return;
    time.value = Math.min(1, Number(time.value) + 1 / 240);
    paint();
    if (Number(time.value) < 1) requestAnimationFrame(step);
    else play.textContent = "Play";
  };
  play.addEventListener("click", () => {
    if (play.textContent === "Play" && Number(time.value) >= 1) time.value = 0;
    play.textContent = play.textContent === "Play" ? "Pause" : "Play";
    step();
  });
  colorBy.addEventListener("change", paint);
  time.addEventListener("input", paint);

  const start = () => {
    try {
      view = new MeshView(canvas, shown);
    } catch (error) {
      told.textContent = `The mesh cannot be drawn: ${error.message}.`;
      return;
    }
    view.range = logarithmicRange(areas.map((area, t) => areaOf(shown, t)));
    const selection = select(canvas);
    const behavior = zoom().scaleExtent([0.5, 1e6]).on("zoom", ({ transform }) => {
      view.transform = transform;
      canvas.dataset.zoom = transform.k.toFixed(3);
      redraw();
    });
    selection.call(behavior);
    const keys = {
      ArrowLeft: () => behavior.translateBy(selection, 60 / view.transform.k, 0),
      ArrowRight: () => behavior.translateBy(selection, -60 / view.transform.k, 0),
      ArrowUp: () => behavior.translateBy(selection, 0, 60 / view.transform.k),
      ArrowDown: () => behavior.translateBy(selection, 0, -60 / view.transform.k),
      "+": () => behavior.scaleBy(selection, 1.5),
      "-": () => behavior.scaleBy(selection, 1 / 1.5),
      0: () => behavior.transform(selection, zoomIdentity),
    };
    canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    let timer = 0;
    canvas.addEventListener("pointermove", (event) => {
      clearTimeout(timer);
      const { offsetX, offsetY } = event;
      timer = setTimeout(() => {
        const t = view.triangleAt(offsetX, offsetY);
        told.textContent = t < 0 ? "" : describe(mesh, t);
      }, 40);
    });
    new ResizeObserver(redraw).observe(canvas);
    offer();
    paint();
  };
  const follow = (next) => {
    record = next;
    if (!view) return;
    time.value = 0;
    offer();
    paint();
  };
  return { place, start, follow };
}
