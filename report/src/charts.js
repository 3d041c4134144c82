import vegaEmbed from "vega-embed";

/** Distinguishable with any color vision (Okabe and Ito 2008). */
export const colors = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#000000"];

const config = {
  range: { category: colors },
  axis: { labelFontSize: 12, titleFontSize: 13, titleFontWeight: "normal" },
  legend: { labelFontSize: 12, titleFontSize: 13 },
  view: { stroke: null },
};

/** Draws a Vega-Lite specification into a place of the page; resolves when it is drawn. */
export function draw(place, specification) {
  const whole = { $schema: "https://vega.github.io/schema/vega-lite/v5.json", width: "container", config, ...specification };
  return vegaEmbed(place, whole, {
    actions: { export: true, source: false, compiled: false, editor: false },
    renderer: "canvas",
  });
}
