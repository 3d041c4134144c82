import { chartSection, named, rankAxis, rankScale, told, topLegend } from "./charts.js";
import { kindsOfTime } from "./runs.js";

const kBars = 2048;
const colors = ["#0072b2", "#e69f00", "#f0e442", "#d55e00", "#e4e4e4"];

/** The scale and legend of what time is spent on. */
export const timeColor = { field: "kind", type: "nominal", sort: null, scale: { domain: kindsOfTime, range: colors },
  legend: topLegend() };
export const timeOrder = { field: "order", type: "quantitative" };

/** How each rank spent its time, as stacked bars up to `end` seconds. */
export function rankTimes(record, end) {
  const ranks = record.parts.ranks;
  const every = Math.ceil(ranks.length / kBars);
  const overlap = ranks.length < 100 ? 0 : 0.3;  // otherwise the paper would shine through between bars as narrow as pixels
  const values = ranks.flatMap(({ seconds }, rank) => {
    if (rank % every > 0) return [];
    let top = 0;
    return kindsOfTime.map((kind) => ({ rank, left: rank - 0.5, right: rank - 0.5 + every + overlap, kind, bottom: top, top: (top += seconds[kind] ?? 0),
      seconds: seconds[kind] ?? 0, speed: record.cluster?.speeds?.[rank] }));
  });
  const most = values.reduce((m, v) => Math.max(m, v.top), end);
  const tooltip = [told("rank", "rank", ",d"), named("kind", "time"), told("seconds", "seconds")];
  if (values[0]?.speed) tooltip.push(told("speed", "triangles per second", ",.0f"));
  return chartSection("Time of each rank", "rank-times", every > 1 ? `One of ${every} ranks is shown.` : "", {
    height: 220, data: { values }, mark: { type: "rect", ...(ranks.length < 100 ? { stroke: "#fff" } : {}) }, encoding: {
      x: { field: "left", type: "quantitative", axis: rankAxis(ranks.length), scale: rankScale(ranks.length) }, x2: { field: "right" },
      y: { field: "bottom", type: "quantitative", title: "seconds", scale: { domain: [0, most], nice: false } }, y2: { field: "top" },
      color: timeColor, tooltip } });
}
