import { chartSection, named, rankAxis, rankScale, told, topLegend } from "./charts.js";
import { busyIntervals, movesOf, ranksOf } from "./runs.js";

const kRows = 1024;  // more would be thinner than a pixel

const blue = "#0072b2", orange = "#e69f00", sky = "#56b4e9";

/** Seconds from 0 to `end`; Ctrl and the wheel zoom in, dragging moves. */
const seconds = (end) => (field) => ({ field, type: "quantitative", title: "seconds", scale: { domain: [0, end], nice: false } });
const zoom = [{ name: "zoom", bind: "scales",
  select: { type: "interval", encodings: ["x"], zoom: "wheel![event.ctrlKey]", clear: "dblclick" } }];

const legendOf = (labels, colors) => ({ scale: { domain: labels, range: colors }, legend: { ...topLegend(), symbolOpacity: 1 } });

/** When each rank refined, and when subdomains moved, to `end` seconds. */
export function timeChart({ record, timeline }, end) {
  const ranks = ranksOf(record, timeline);
  const every = Math.ceil(ranks / kRows);
  const row = (rank) => ({ top: rank - 0.5, bottom: rank - 0.5 + every });
  const busy = busyIntervals(timeline).filter((b) => b.rank % every === 0).map((b) => ({ ...b, ...row(b.rank) }));
  const moves = movesOf(record), plans = timeline.plans;
  const height = Math.ceil(ranks / every) * Math.max(1, Math.min(ranks > 4 ? 22 : 36, Math.floor(720 / ranks)));
  const x = seconds(end);
  const y = (field) => ({ field, type: "quantitative", axis: rankAxis(ranks), scale: { ...rankScale(ranks), reverse: true } });
  const color = legendOf(["refines", "subdomain on its way"], [blue, orange]);
  const layer = [{ params: zoom, data: { values: busy }, mark: { type: "rect", clip: true, ...(height / ranks > 6 ? { stroke: "#fff", strokeWidth: 1 } : {}) },
    encoding: { x: x("start"), x2: { field: "stop" }, y: y("top"), y2: { field: "bottom" }, color: { datum: "refines", ...color },
      tooltip: [told("rank", "rank", ",d"), told("start", "from (s)"), told("stop", "to (s)"), told("triangles", "triangles so far", ",d")] } }];
  if (moves.length > 0)
    layer.push({ data: { values: moves }, mark: { type: "rule", clip: true, opacity: Math.max(0.12, Math.min(0.8, 150 / moves.length)) },
      encoding: { x: x("left"), x2: { field: "arrived" }, y: y("from"), y2: { field: "to" }, color: { datum: "subdomain on its way", ...color },
        tooltip: [told("subdomain", "subdomain", ",d"), told("from", "from rank", ",d"), told("to", "to rank", ",d"), told("left", "left (s)"),
          told("arrived", "arrived (s)"), told("bytes", "bytes", ",d")] } });
  if (plans.length > 0)
    layer.push({ data: { values: plans }, mark: { type: "point", clip: true, filled: true, stroke: "#000", fill: "#fff", strokeWidth: 1.2,
      size: ranks > 200 ? 25 : 60 }, encoding: { x: x("time"), y: y("rank"),
        shape: { field: "plan", type: "nominal", scale: { domain: ["made", "rejected"], range: ["triangle-up", "cross"] },
          legend: { ...topLegend(), labelExpr: "datum.label == 'made' ? 'plan made or followed' : 'plan rejected'" } },
        tooltip: [named("what"), told("rank", "rank", ",d"), told("time", "at (s)"), told("moves", "moves", ",d")] } });
  return chartSection("Timeline", "timeline", `${every > 1 ? `One of ${every} ranks is shown. ` : ""}Drag to move, Ctrl and the wheel (or two `
    + "fingers) to zoom in, double-click for all.", { height, layer });
}

/** The work that is left over time, to `end` seconds. */
export function workLeft({ timeline }, end) {
  const x = seconds(end)("time");
  const y = { type: "quantitative", title: "triangles to be made", axis: { format: "~s" } };
  const color = legendOf(["from least to most of all ranks", "mean"], [sky, blue]);
  return chartSection("Work left on a rank", "load", "", { height: 220, data: { values: timeline.load }, encoding: { x }, layer: [
    { mark: { type: "area", opacity: 0.5 }, encoding: { y: { field: "least", ...y }, y2: { field: "most" },
      color: { datum: "from least to most of all ranks", ...color } } },
    { mark: { type: "line" }, encoding: { y: { field: "mean", ...y }, color: { datum: "mean", ...color } } },
    { mark: { type: "rule", opacity: 0 }, encoding: { tooltip: [told("time", "at (s)"), told("least", "least", ",.0f"),
      told("mean", "mean", ",.0f"), told("most", "most", ",.0f")] } }] });
}
