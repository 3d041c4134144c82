// How millions of triangles are sorted so that few must be drawn: by size, and by place. Where triangles are smaller than
// pixels, an image of their mean color stands for them; elsewhere only those in sight are drawn. Coordinates are from -1 to 1.

const kGrids = [16, 64];                // cells along a side, by which triangles are sorted: larger ones, and all others
export const kImages = [512, 1024, 2048];  // cells of the images along a side
const kSmall = 0.45;                    // of a cell: triangles that an image stands for are no larger
const kCovered = 0.2;                   // of the area of a cell that is not left empty

const cellOf = (x, cells) => Math.min(cells - 1, Math.max(0, Math.floor(((x + 1) / 2) * cells)));

const kClasses = 3 + kImages.length;

/** 0 if it may reach beyond its neighbors' cells in both grids, 1 if in the second one, k + 2 if the first k images stand for it. */
function sizeClass(size) {
  if (size > 2 / kGrids[0]) return 0;
  if (size > 2 / kGrids[1]) return 1;
  let k = kImages.length;
  while (k > 0 && size > (kSmall * 2) / kImages[k - 1]) --k;
  return k + 2;
}

const gridOf = (k) => kGrids[Math.min(k - 1, 1)];
/** The first bucket of a class; a class has one for each cell, class 0 only one. */
const firstBucket = (k) => (k === 0 ? 0 : k === 1 ? 1 : 1 + kGrids[0] ** 2 + (k - 2) * kGrids[1] ** 2);

/** The place of each triangle in the new order: {order, triangles, starts}, `starts` for each class and cell. */
export function sortTriangles(points, triangles) {
  const count = triangles.length / 3;
  const buckets = firstBucket(kClasses);
  const bucket = new Uint16Array(count);
  const starts = new Uint32Array(buckets + 1);
  for (let t = 0; t < count; ++t) {
    const a = 2 * triangles[3 * t], b = 2 * triangles[3 * t + 1], c = 2 * triangles[3 * t + 2];
    const ax = points[a], ay = points[a + 1], bx = points[b], by = points[b + 1], cx = points[c], cy = points[c + 1];
    const size = Math.max(ax, bx, cx) - Math.min(ax, bx, cx), high = Math.max(ay, by, cy) - Math.min(ay, by, cy);
    const k = sizeClass(Math.max(size, high));
    const grid = k === 0 ? 1 : gridOf(k);
    bucket[t] = firstBucket(k) + cellOf((ay + by + cy) / 3, grid) * grid + cellOf((ax + bx + cx) / 3, grid);
    ++starts[bucket[t] + 1];
  }
  for (let k = 0; k < buckets; ++k) starts[k + 1] += starts[k];
  const next = starts.slice();
  const order = new Uint32Array(count), sorted = new Uint32Array(3 * count);
  for (let t = 0; t < count; ++t) {
    const at = next[bucket[t]]++;
    order[at] = t;
    for (let k = 0; k < 3; ++k) sorted[3 * at + k] = triangles[3 * t + k];
  }
  return { order, triangles: sorted, starts };
}

/** The first triangle that image `level` stands for: all that follow are such. */
export const firstInImage = (starts, level) => starts[firstBucket(level + 3)];

/** Ranges of triangles, [from, to), that may be seen between the corners; of classes up to `level`, or all for null. */
export function rangesInSight(starts, [x0, y0, x1, y1], level) {
  const ranges = [];
  const add = (from, to) => {
    if (from === to) return;
    const last = ranges[ranges.length - 1];
    if (last && last[1] === from) last[1] = to;
    else ranges.push([from, to]);
  };
  add(0, starts[1]);
  if (x1 < -1 || y1 < -1 || x0 > 1 || y0 > 1) return ranges;
  for (let k = 1; k < (level === null ? kClasses : level + 3); ++k) {
    const grid = gridOf(k);
    const left = Math.max(0, cellOf(x0, grid) - 1), right = Math.min(grid - 1, cellOf(x1, grid) + 1);
    const low = Math.max(0, cellOf(y0, grid) - 1), high = Math.min(grid - 1, cellOf(y1, grid) + 1);
    for (let row = low; row <= high; ++row) {
      const start = firstBucket(k) + row * grid;
      add(starts[start + left], starts[start + right + 1]);
    }
  }
  return ranges;
}

/** The image that will do where a unit is so many pixels: its level, or null. */
export function levelFor(pixels) {
  const level = kImages.findIndex((cells) => (2 * pixels) / cells <= 1.25);
  return level < 0 ? null : level;
}

function eachInImage(mesh, level, visit) {
  const { points, triangles, starts } = mesh;
  const cells = kImages[level];
  for (let t = firstInImage(starts, level); t < triangles.length / 3; ++t) {
    const a = 2 * triangles[3 * t], b = 2 * triangles[3 * t + 1], c = 2 * triangles[3 * t + 2];
    const x = (points[a] + points[b] + points[c]) / 3, y = (points[a + 1] + points[b + 1] + points[c + 1]) / 3;
    visit(t, cellOf(y, cells) * cells + cellOf(x, cells));
  }
}

/** Cells without a value between two that have one get it from one of them: where few triangles are in a cell, chance may
 * have put none of their centers there. */
function closeGaps(values, cells, isEmpty) {
  const gaps = [];
  for (let row = 1; row + 1 < cells; ++row)
    for (let i = row * cells + 1; i < (row + 1) * cells - 1; ++i)
      if (isEmpty(values[i]))
        for (const step of [1, cells])
          if (!isEmpty(values[i - step]) && !isEmpty(values[i + step])) gaps.push([i, values[i - step]]);
  for (const [i, value] of gaps) values[i] = value;
  return values;
}

/** For each cell of an image the mean of `values`, NaN where there is nothing. `areas` are in units of the image's side. */
export function meansOf(mesh, level, values, areas) {
  const side = kImages[level], cells = side ** 2;
  const sums = new Float32Array(cells), covered = new Float32Array(cells);
  eachInImage(mesh, level, (t, cell) => {
    sums[cell] += values[t] * areas[t];
    covered[cell] += areas[t];
  });
  const enough = (kCovered * 4) / cells;
  for (let cell = 0; cell < cells; ++cell) sums[cell] = covered[cell] < enough ? NaN : sums[cell] / covered[cell];
  return closeGaps(sums, side, Number.isNaN);
}

/** For each cell the number of one of its triangles, -1 where there is nothing. */
export function numbersOf(mesh, level, numbers, areas) {
  const side = kImages[level], cells = side ** 2;
  const found = new Int32Array(cells).fill(-1), covered = new Float32Array(cells);
  eachInImage(mesh, level, (t, cell) => {
    found[cell] = numbers[t];
    covered[cell] += areas[t];
  });
  const enough = (kCovered * 4) / cells;
  for (let cell = 0; cell < cells; ++cell) if (covered[cell] < enough) found[cell] = -1;
  return closeGaps(found, side, (n) => n < 0);
}
