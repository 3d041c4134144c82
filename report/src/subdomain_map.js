import { Delaunay } from "d3-delaunay";
import { css, ofCategory } from "./colors.js";
import { element, number, section } from "./elements.js";
import { replayControls } from "./replay.js";
import { movesOf, ownersAt, secondsOf } from "./runs.js";

const kMargin = 20;  // pixels
const kMostSeams = 6000;
const kTangents = 16;
const kReach = 1.6;  // of the distance to the nearest neighbors: how far a subdomain can be seen from its center

/** Whether a record says where its subdomains lie and who has them. */
export const hasMap = (record) => record.cluster?.subdomains?.x?.length > 2 && record.cluster.owners_before?.length > 2;

const extent = (values) => values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
const heightFor = ({ x, y }, width) => Math.min(Math.max((width * extent(y)) / (extent(x) || 1), 220), 560);

/** The part of a convex polygon within a circle, nearly: within its tangents in some directions (Sutherland and Hodgman 1974). */
function withinCircle(polygon, center, radius) {
  let left = polygon;
  for (let k = 0; k < kTangents && left.length > 0; ++k) {
    const direction = [Math.cos((2 * Math.PI * k) / kTangents), Math.sin((2 * Math.PI * k) / kTangents)];
    const beyond = (p) => direction[0] * (p[0] - center[0]) + direction[1] * (p[1] - center[1]) - radius;
    left = left.flatMap((p, i) => {
      const q = left[(i + 1) % left.length], a = beyond(p), b = beyond(q);
      const crossing = a * b < 0 ? [[p[0] + ((q[0] - p[0]) * a) / (a - b), p[1] + ((q[1] - p[1]) * a) / (a - b)]] : [];
      return a <= 0 ? [p, ...crossing] : crossing;
    });
  }
  return left;
}

/** What is drawn for each subdomain, fitted into a canvas: {paths, find(x, y)}. A record has centers only, so each gets what is
 * nearer to it than to the others, but not too far. */
function cellsOf({ x, y }, width, height) {
  const least = (values) => values.reduce((a, b) => Math.min(a, b)), most = (values) => values.reduce((a, b) => Math.max(a, b));
  const low = [least(x), least(y)], high = [most(x), most(y)];
  const unit = Math.min((width - 2 * kMargin) / (high[0] - low[0] || 1), (height - 2 * kMargin) / (high[1] - low[1] || 1));
  const left = (width - unit * (high[0] - low[0])) / 2, top = (height - unit * (high[1] - low[1])) / 2;
  const centers = x.map((_, s) => [left + unit * (x[s] - low[0]), height - top - unit * (y[s] - low[1])]);
  const delaunay = Delaunay.from(centers);
  const voronoi = delaunay.voronoi([0, 0, width, height]);
  const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const paths = centers.map((center, s) => {
    const around = [...delaunay.neighbors(s)].map((n) => distance(center, centers[n])).sort((a, b) => a - b);
    const radius = Math.max(1.5, (kReach / 2) * (around[Math.min(2, around.length - 1)] ?? width));
    const path = new Path2D();
    withinCircle(voronoi.cellPolygon(s) ?? [], center, radius).forEach((p, k) => path[k === 0 ? "moveTo" : "lineTo"](...p));
    path.closePath();
    return path;
  });
  return { paths, find: (px, py) => delaunay.find(px, py) };
}

function paint(canvas, paths, owners, before) {
  const scale = window.devicePixelRatio || 1;
  canvas.width = Math.round(canvas.clientWidth * scale);
  canvas.height = Math.round(canvas.clientHeight * scale);
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  context.lineWidth = 0.5;
  context.strokeStyle = "#fff";
  paths.forEach((path, s) => {
    context.fillStyle = css(ofCategory(owners[s]));
    context.fill(path);
    if (paths.length < kMostSeams) context.stroke(path);
  });
  context.lineWidth = 1.2;
  context.strokeStyle = "#000";
  paths.forEach((path, s) => owners[s] !== before[s] && context.stroke(path));
}

/** The subdomains of a run in the color of their ranks, over time. */
export function subdomainMap({ record, name }) {
  const moves = movesOf(record);
  const { subdomains, owners_before: before } = record.cluster;
  const made = section("Subdomains by rank", "Around the center of each, in the color of its rank; colors repeat after 28 ranks."
    + (moves.length > 0 ? " An outline tells that it has moved." : ""));
  const canvas = element("canvas", { class: "map", role: "img", "aria-label": `Subdomains of ${name}` });
  const told = element("p", { class: "told", "aria-live": "polite" });
  let cells = null;
  const redraw = (now) => cells && paint(canvas, cells.paths, ownersAt(record, now), before);
  const replay = replayControls(`${name}-`, redraw);
  if (moves.length > 0) replay.show(secondsOf(record));
  else replay.hide();
  canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => {
    if (!cells) return;
    const s = cells.find(offsetX, offsetY);
    told.textContent = `Subdomain ${s} on rank ${ownersAt(record, replay.moment())[s]}: ${number(Math.round(subdomains.work[s]))} triangles of work, `
      + `${number(Math.round(subdomains.forecast[s]))} expected`;
  });
  new ResizeObserver(() => {
    if (canvas.clientWidth === 0) return;
    canvas.style.height = `${heightFor(subdomains, canvas.clientWidth)}px`;
    cells = cellsOf(subdomains, canvas.clientWidth, canvas.clientHeight);
    redraw(replay.moment());
  }).observe(canvas);
  made.append(replay.place, canvas, told);
  return made;
}
