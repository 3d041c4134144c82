// node --test mesh_test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import { unpacked } from "../src/data.js";
import * as levels from "../src/mesh_levels.js";
import * as values from "../src/mesh_values.js";

/** Numbers from 0 to 1, the same each time. */
function generator(seed) {
  let state = seed;
  return () => (state = (state * 1103515245 + 12345) % 2147483648) / 2147483648;
}

/** Triangles of very different sizes anywhere in the square. */
function randomMesh(count) {
  const next = generator(7);
  const points = new Float32Array(6 * count), triangles = new Uint32Array(3 * count);
  for (let t = 0; t < count; ++t) {
    const size = 10 ** (-4 * next()), x = 2 * next() - 1, y = 2 * next() - 1;
    for (let k = 0; k < 3; ++k) {
      points[6 * t + 2 * k] = Math.min(1, Math.max(-1, x + size * (next() - 0.5)));
      points[6 * t + 2 * k + 1] = Math.min(1, Math.max(-1, y + size * (next() - 0.5)));
      triangles[3 * t + k] = 3 * t + k;
    }
  }
  return { points, triangles };
}

const boxOf = ({ points, triangles }, t) => {
  const x = [0, 1, 2].map((k) => points[2 * triangles[3 * t + k]]), y = [0, 1, 2].map((k) => points[2 * triangles[3 * t + k] + 1]);
  return [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
};

test("base64 of any length is read", () => {
  for (let length = 0; length < 40; ++length) {
    const bytes = Uint8Array.from({ length }, (_, k) => (k * 151 + length * 7) % 256);
    assert.deepEqual(unpacked(Buffer.from(bytes).toString("base64")), bytes);
  }
});

test("sorting keeps each triangle with its number", () => {
  const { points, triangles } = randomMesh(5000);
  const sorted = levels.sortTriangles(points, triangles);
  assert.deepEqual([...sorted.order].sort((a, b) => a - b), [...sorted.order.keys()]);
  sorted.order.forEach((t, at) => assert.deepEqual(sorted.triangles.slice(3 * at, 3 * at + 3), triangles.slice(3 * t, 3 * t + 3)));
});

test("all triangles that touch what is in sight are drawn, or are in the image", () => {
  const { points, triangles } = randomMesh(5000);
  const sorted = { points, ...levels.sortTriangles(points, triangles) };
  const next = generator(3);
  for (let round = 0; round < 60; ++round) {
    const size = 10 ** (-3 * next()), x = 2 * next() - 1, y = 2 * next() - 1;
    const sight = [x, y, x + size, y + size];
    const level = round % 4 === 3 ? null : round % 4;
    const drawn = new Uint8Array(5000);
    for (const [from, to] of levels.rangesInSight(sorted.starts, sight, level)) for (let t = from; t < to; ++t) ++drawn[t];
    assert.ok(drawn.every((times) => times <= 1));
    for (let t = 0; t < (level === null ? 5000 : levels.firstInImage(sorted.starts, level)); ++t) {
      const box = boxOf(sorted, t);
      if (box[0] <= sight[2] && box[2] >= sight[0] && box[1] <= sight[3] && box[3] >= sight[1]) assert.equal(drawn[t], 1, `triangle ${t}`);
    }
  }
});

test("an image stands for triangles smaller than its cells, and for no others", () => {
  const { points, triangles } = randomMesh(5000);
  const sorted = { points, ...levels.sortTriangles(points, triangles) };
  levels.kImages.forEach((cells, level) => {
    const first = levels.firstInImage(sorted.starts, level);
    for (let t = 0; t < 5000; ++t) {
      const [x0, y0, x1, y1] = boxOf(sorted, t);
      assert.equal(Math.max(x1 - x0, y1 - y0) <= (0.45 * 2) / cells, t >= first, `triangle ${t}`);
    }
  });
});

test("cells have means by area, and nothing where little is covered", () => {
  const cell = 2 / levels.kImages[2];
  const corner = (x, y) => [x * cell, y * cell];
  // Two triangles in one cell, one of twice the area; and a tiny one in another.
  const points = Float32Array.from([corner(0.1, 0.1), corner(0.5, 0.1), corner(0.1, 0.4), corner(0.5, 0.9), corner(0.9, 0.5), corner(0.9, 0.9),
    corner(5.5, 0.5), corner(5.6, 0.5), corner(5.5, 0.6)].flat());
  const mesh = { points, ...levels.sortTriangles(points, Uint32Array.from({ length: 9 }, (_, k) => k)) };
  const { areas } = values.measure(points, mesh.triangles);
  const given = Float32Array.from(mesh.order, (t) => [10, 40, 7][t]);
  const wide = areas.map((area) => area * 2);  // together they cover enough
  const means = levels.meansOf(mesh, 2, given, wide);
  const filled = [...means.keys()].filter((k) => !Number.isNaN(means[k]));
  assert.equal(filled.length, 1);
  const byNumber = [...mesh.order].reduce((all, t, at) => ({ ...all, [t]: areas[at] }), {});
  const expected = (10 * byNumber[0] + 40 * byNumber[1]) / (byNumber[0] + byNumber[1]);
  assert.ok(Math.abs(means[filled[0]] - expected) < 1e-3);
  const numbers = levels.numbersOf(mesh, 2, Uint32Array.from(mesh.order), wide);
  assert.deepEqual([...numbers.keys()].filter((k) => numbers[k] >= 0), filled);
});

test("a gap between cells that have something is closed", () => {
  const side = levels.kImages[0], cell = 2 / side;
  const triangleIn = (column, row) => [[0.3, 0.3], [0.7, 0.3], [0.3, 0.7]].flatMap(([x, y]) => [(column + x) * cell - 1, (row + y) * cell - 1]);
  const points = Float32Array.from([triangleIn(9, 9), triangleIn(11, 9), triangleIn(20, 20)].flat());
  const mesh = { points, ...levels.sortTriangles(points, Uint32Array.from({ length: 9 }, (_, k) => k)) };
  const whole = new Float32Array(3).fill(cell * cell);
  const means = levels.meansOf(mesh, 0, Float32Array.from(mesh.order, (t) => [5, 6, 7][t]), whole);
  const at = (column, row) => means[row * side + column];
  assert.deepEqual([at(9, 9), at(10, 9), at(11, 9), at(20, 20)], [5, 5, 6, 7]);
  assert.equal(means.filter((m) => !Number.isNaN(m)).length, 4);
});

test("areas, smallest angles, longest edges and histograms", () => {
  const points = Float32Array.from([0, 0, 4, 0, 0, 3, 4, 3]);
  const { areas, angles, edges } = values.measure(points, Uint32Array.from([0, 1, 2, 1, 3, 2]));
  assert.deepEqual([...areas], [6, 6]);
  assert.deepEqual([...edges], [5, 5]);
  for (const angle of angles) assert.ok(Math.abs(angle - (Math.atan2(3, 4) * 180) / Math.PI) < 1e-4);
  assert.deepEqual(values.histogram([0, 1, 1.5, 4], [0, 4], 4, false).map((b) => b.count), [1, 2, 0, 1]);
  assert.deepEqual(values.histogram([1, 4, 10, 27], [1, 27], 3, true).map((b) => b.count), [1, 1, 2]);
  assert.deepEqual(values.rangeOf([0, 3, 1]), [1, 3]);
});

test("a mesh is moved into a square, and its place is not lost", () => {
  const points = Float32Array.from([10, 20, 30, 24]);
  const { length, middle, half } = values.intoSquare(points);
  assert.deepEqual([[...points], { length, middle, half }], [[-1, -0.20000000298023224, 1, 0.20000000298023224], { length: 10, middle: [20, 22], half: [1, 0.2] }]);
});

test("frames share a square", () => {
  const points = Float32Array.from([0, 0, 1, 0, 0, 1]);
  assert.deepEqual(values.boxAround(points), [[0, 0], [1, 1]]);
  const { length, middle, half } = values.intoSquare(points, [[-4, 0], [4, 2]]);
  assert.deepEqual([[...points], { length, middle, half }], [[0, -0.25, 0.25, -0.25, 0, 0], { length: 4, middle: [0, 1], half: [1, 0.25] }]);
});

test("values at points are linear in triangles", () => {
  const mesh = { points: Float32Array.from([0, 0, 2, 0, 0, 1, 2, 1]), triangles: Uint32Array.from([0, 1, 2, 1, 3, 2]) };
  const plane = Float32Array.from([5, 9, 4, 8]);  // 5 + 2x - y
  assert.deepEqual([...values.meansOfCorners(plane, mesh.triangles)], [6, 7]);
  assert.equal(values.valueAt(mesh, plane, 0, [0.5, 0.25]), 5.75);
  assert.equal(values.valueAt(mesh, plane, 1, [1.5, 0.75]), 7.25);
  assert.ok(Number.isNaN(values.valueAt(mesh, Float32Array.from([NaN, 9, 4, 8]), 0, [0.5, 0.25])));
});

test("a range that is mere rounding is flat, and its value in the middle of the scale", () => {
  const next = (x) => {
    const float = Float32Array.of(x);
    ++new Int32Array(float.buffer)[0];
    return float[0];
  };
  for (const value of [7, 1, 1.999, 1e-30, 3e38]) {
    for (const range of [[value, value], [value, next(value)], [-next(value), -value]]) {
      assert.ok(values.isFlat(range), `${range}`);
      const ends = values.endsOfScale(range).map(Math.fround);
      for (const x of range) assert.ok(Math.abs((x - ends[0]) / (ends[1] - ends[0]) - 0.5) < 1e-3, `${range} ${ends}`);
    }
    for (const range of [[value, value * (1 + 1e-6)], [-value, value], [0, value]]) assert.deepEqual(values.endsOfScale(range), range);
  }
  for (const range of [[0, 0], [NaN, NaN]]) assert.deepEqual(values.endsOfScale(range), [-1, 1]);
});
