import vegaEmbed from "vega-embed";
import { colors } from "./colors.js";
import { element, section } from "./elements.js";

const config = {
  range: { category: colors },
  font: "system-ui, sans-serif",
  axis: { labelFontSize: 12, titleFontSize: 13, titleFontWeight: "normal", gridColor: "#e8e8e8", labelColor: "#333" },
  axisX: { tickCount: 10, labelOverlap: true },
  legend: { labelFontSize: 12, titleFontSize: 13, titleFontWeight: "normal", labelLimit: 400 },
  view: { stroke: null },
};

/** Draws a Vega-Lite specification into a place of the page; resolves when it is drawn. */
export function draw(place, specification) {
  const name = place.id || place.classList[1];
  const whole = { $schema: "https://vega.github.io/schema/vega-lite/v5.json", width: "container",
    config, ...specification };
  return vegaEmbed(place, whole, {
    actions: { export: true, source: false, compiled: false, editor: false },
    renderer: "canvas",
    downloadFileName: name,
    tooltip: { theme: "light" },
  });
}

/** A section with one chart, whose class says of which `kind` it is. */
export function chartSection(title, kind, note, specification) {
  const made = section(title, note);
  const place = element("div", { class: `chart ${kind}` });
  made.append(place);
  draw(place, specification);
  return made;
}

/** A legend above a chart, in two columns where there is little room. */
export const topLegend = () => ({ orient: "top", title: null, columns: window.innerWidth < 600 ? 2 : 0, labelLimit: Math.min(400, window.innerWidth - 110) });

/** A field of a tooltip, with four significant digits unless `format` says otherwise. */
export const told = (field, title = field, format = ",.4~g") => ({ field, title, type: "quantitative", format });
export const named = (field, title = field) => ({ field, title, type: "nominal" });

/** The axis of ranks: whole numbers, each in the middle of a row that is 1 wide. */
export const rankScale = (ranks) => ({ domain: [-0.5, ranks - 0.5], nice: false, zero: false });
export const rankAxis = (ranks) => ({ title: "rank", tickMinStep: 1, format: ",d", grid: false,
  ...(ranks <= 24 ? { values: Array.from({ length: ranks }, (_, rank) => rank) } : {}) });
