import { chartSection, told } from "./charts.js";
import { element, number, section } from "./elements.js";
import { categoryLegend, scaleLegend } from "./legends.js";
import { meshCanvas } from "./mesh_canvas.js";
import { sortTriangles } from "./mesh_levels.js";
import { histogram, intoSquare, measure, rangeOf } from "./mesh_values.js";
import { replayControls } from "./replay.js";
import { movesOf, ownersAt, secondsOf } from "./runs.js";

const kOverTime = "rank over time";

function chartOf(title, kind, note, values, x) {
  return chartSection(title, kind, note, { data: { values }, height: 180, mark: { type: "rect", color: "#0072b2", stroke: "#fff", strokeWidth: 0.5 },
    encoding: { x: { field: "from", type: "quantitative", ...x }, x2: { field: "to" },
      y: { field: "count", type: "quantitative", title: "triangles", axis: { format: "~s" } }, y2: { datum: 0 },
      tooltip: [told("from", "from"), told("to", "to"), told("count", "triangles", ",d")] } });
}

/** Numbers from 0 for the categories of a column, and their names: ranks and subdomains have such numbers, attributes of regions
 * are any values. */
function categoriesOf(name, column, order) {
  if (name !== "region") {
    const numbers = Uint32Array.from(order, (t) => Math.max(0, column[t]));
    return { numbers, names: Array.from({ length: numbers.reduce((a, b) => Math.max(a, b), 0) + 1 }, (_, n) => n) };
  }
  const names = [...new Set(column)].sort((a, b) => a - b);
  const place = new Map(names.map((value, n) => [value, n]));
  return { numbers: Uint32Array.from(order, (t) => place.get(column[t])), names };
}

/** The mesh in the order in which it is drawn, with its columns; `length` and `middle` lead back to the input. */
function prepared(mesh) {
  const { length, middle, half } = intoSquare(mesh.points);
  const sorted = sortTriangles(mesh.points, mesh.triangles);
  const { sizes, ...categories } = mesh.columns;
  const columns = Object.fromEntries(Object.entries(categories).map(([name, column]) =>
    [name, categoriesOf(name, column, sorted.order)]));
  return { ...sorted, points: mesh.points, columns, ...measure(mesh.points, sorted.triangles), length, half,
    sizes: sizes && Float32Array.from(sorted.order, (t) => sizes[t]), middle: middle.map((x, d) => x + mesh.middle[d]) };
}

/** What triangles have values of, by name: {values, range, legend}, the values computed when they are first asked for. */
function scalesOf(shown) {
  const [least, greatest] = rangeOf(shown.areas);
  const unitArea = shown.length ** 2;
  const scale = (valuesOf, range, legend) => {
    let values = null;
    return { get values() { return (values ??= valuesOf()); }, range, legend };
  };
  const scales = {
    area: scale(() => shown.areas.map(Math.log), [least, greatest].map(Math.log), [least * unitArea, greatest * unitArea, "area"]),
    angle: scale(() => shown.angles, [0, 60], [0, 60, "smallest angle (degrees)"]),
  };
  if (!shown.sizes) return scales;
  const range = rangeOf(shown.sizes);
  scales.size = scale(() => shown.sizes.map(Math.log), range.map(Math.log), [...range, "length asked for"]);
  scales["edge to size"] = scale(() => shown.edges.map((edge, t) => (edge * shown.length) / shown.sizes[t]), [0, 1.25],
    [0, 1.25, "longest edge to the length asked for"]);
  return scales;
}

/** Charts of the areas and smallest angles. */
function distributions(shown, range) {
  const unitArea = shown.length ** 2;
  return element("div", { class: "beside" },
    chartOf("Areas", "areas", "In intervals of equal ratio; the unit is the square of the input's.",
      histogram(shown.areas, range, 40, true).map((b) => ({ ...b, from: b.from * unitArea, to: b.to * unitArea })),
      { title: "area", scale: { type: "log", nice: false }, axis: { format: ".3~g", labelOverlap: true } }),
    chartOf("Smallest angles", "smallest-angles", "One of each triangle.", histogram(shown.angles, [0, 60], 60, false),
      { title: "degrees", scale: { domain: [0, 60] } }));
}

/** The mesh with its controls: {place, start(), follow(record)}. start() once the place is in the page. */
export function meshSection(mesh, firstRecord) {
  let record = firstRecord;
  const place = section(`Mesh ${mesh.name}`, "Drag or arrow keys move, the wheel or + and - zoom, 0 shows all. Where triangles are smaller "
    + "than a pixel, their mean is shown.");
  const colorBy = element("select", { id: "color-by" });
  const replay = replayControls("", () => paint());
  const key = element("span", { class: "legend", id: "legend" });
  const drawn = meshCanvas({ canvasId: "mesh", saidId: "told", label: "The mesh" }, (t, at) => describe(t, at));
  place.append(element("div", { class: "controls" }, element("label", {}, "Color: ", colorBy), key, replay.place),
    element("div", { class: "mesh" }, drawn.canvas), drawn.said);

  const shown = prepared(mesh);
  const unitArea = shown.length ** 2;
  const scales = scalesOf(shown);
  place.append(distributions(shown, rangeOf(shown.areas)));

  const hasOwners = () => shown.columns.subdomain && record?.cluster?.owners_before && movesOf(record).length > 0 &&
    shown.columns.subdomain.names.length <= record.cluster.owners_before.length;
  const offer = () => {
    const before = colorBy.value;
    const names = [...Object.keys(scales), ...Object.keys(shown.columns), ...(hasOwners() ? [kOverTime] : [])];
    colorBy.replaceChildren(...names.map((name) => element("option", {}, name)));
    colorBy.value = names.includes(before) ? before : shown.columns.rank ? "rank" : "area";
    if (hasOwners()) replay.show(secondsOf(record));
  };
  const paint = () => {
    const view = drawn.view();
    if (!view) return;
    const by = colorBy.value;
    replay.place.style.display = by === kOverTime ? "" : "none";
    if (by in scales) {
      key.replaceChildren(...scaleLegend(...scales[by].legend));
      view.byValues(scales[by].values, scales[by].range);
    } else if (by === kOverTime) {
      key.replaceChildren(...categoryLegend(record.parts.ranks.map((_, rank) => rank)));
      view.byCategories(shown.columns.subdomain.numbers, ownersAt(record, replay.moment()));
    } else {
      key.replaceChildren(...categoryLegend(shown.columns[by].names));
      view.byCategories(shown.columns[by].numbers);
    }
    drawn.redraw();
  };
  colorBy.addEventListener("change", paint);

  const describe = (t, [x, y]) => {
    const at = [x, y].map((c, d) => number(shown.middle[d] + c * shown.length, 7));
    const columns = Object.keys(shown.columns).map((name) => `, ${name} ${mesh.columns[name][shown.order[t]]}`);
    if (shown.sizes) columns.push(`, longest edge ${number(shown.edges[t] * shown.length)} where ${number(shown.sizes[t])} is asked for`);
    return `triangle ${number(shown.order[t])} at (${at.join(", ")}), area ${number(shown.areas[t] * unitArea)}, smallest angle `
      + `${number(shown.angles[t])} degrees${columns.join("")}`;
  };
  const start = () => {
    if (!drawn.begin(shown)) return;
    offer();
    paint();
  };
  const follow = (next) => {
    record = next;
    if (!drawn.view()) return;
    offer();
    paint();
  };
  return { place, start, follow };
}
