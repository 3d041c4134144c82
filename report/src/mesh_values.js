// Figures of triangles. Pure functions.

/** The low and the high corner of the least box around points. */
export function boxAround(points) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    const d = i & 1;
    if (points[i] < low[d]) low[d] = points[i];
    if (points[i] > high[d]) high[d] = points[i];
  }
  return [low, high];
}

/** Moved and scaled so that the box, if not told otherwise around all, is in a square of side 2. In place; returns {length, middle,
 * half}: of a unit, and of the box, in the former lengths; and half of the sides of the box in the new ones. */
export function intoSquare(points, [low, high] = boxAround(points)) {
  const length = Math.max(high[0] - low[0], high[1] - low[1]) / 2 || 1;
  const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  for (let i = 0; i < points.length; ++i) points[i] = (points[i] - middle[i & 1]) / length;
  return { length, middle, half: [(high[0] - low[0]) / 2 / length, (high[1] - low[1]) / 2 / length] };
}

/** For each triangle the mean of the values at its corners. */
export function meansOfCorners(values, triangles) {
  const means = new Float32Array(triangles.length / 3);
  for (let t = 0; t < means.length; ++t)
    means[t] = (values[triangles[3 * t]] + values[triangles[3 * t + 1]] + values[triangles[3 * t + 2]]) / 3;
  return means;
}

/** What the linear function with these values at the corners of triangle t is at a place. */
export function valueAt({ points, triangles }, values, t, [x, y]) {
  const [a, b, c] = triangles.subarray(3 * t, 3 * t + 3);
  const ux = points[2 * b] - points[2 * a], uy = points[2 * b + 1] - points[2 * a + 1];
  const vx = points[2 * c] - points[2 * a], vy = points[2 * c + 1] - points[2 * a + 1];
  const wx = x - points[2 * a], wy = y - points[2 * a + 1];
  const whole = ux * vy - uy * vx || 1;
  const ofB = (wx * vy - wy * vx) / whole, ofC = (ux * wy - uy * wx) / whole;
  return values[a] + ofB * (values[b] - values[a]) + ofC * (values[c] - values[a]);
}

/** Areas, smallest angles (degrees) and longest edges of all triangles. */
export function measure(points, triangles) {
  const count = triangles.length / 3;
  const areas = new Float32Array(count), angles = new Float32Array(count), edges = new Float32Array(count);
  for (let t = 0; t < count; ++t) {
    const a = 2 * triangles[3 * t], b = 2 * triangles[3 * t + 1], c = 2 * triangles[3 * t + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1];
    const wx = vx - ux, wy = vy - uy;
    const twice = Math.abs(ux * vy - uy * vx);
    const uu = ux * ux + uy * uy, vv = vx * vx + vy * vy, ww = wx * wx + wy * wy;
    // The smallest angle is opposite to the shortest side; its cosine follows from all three.
    const shortest = Math.min(uu, vv, ww);
    areas[t] = twice / 2;
    angles[t] = (Math.atan2(twice, (uu + vv + ww) / 2 - shortest) * 180) / Math.PI;
    edges[t] = Math.sqrt(Math.max(uu, vv, ww));
  }
  return { areas, angles, edges };
}

/** The least and the greatest value above 0. */
export function rangeOf(values) {
  let least = Infinity, greatest = 0;
  for (const value of values) {
    if (value > 0 && value < least) least = value;
    if (value > greatest) greatest = value;
  }
  return [Math.min(least, greatest), greatest];
}

/** Whether values from `least` to `greatest`, which are single precision, differ by no more than their rounding. */
export function isFlat([least, greatest]) {
  return !(greatest - least > 2 ** -23 * Math.max(Math.abs(least), Math.abs(greatest)));
}

/** The values for the two ends of the scale of colors: those of the range, or further apart where that is flat or nothing. */
export function endsOfScale(range) {
  if (!isFlat(range)) return range;
  const middle = (range[0] + range[1]) / 2 || 0, wide = Math.abs(middle) / 1000 || 1;
  return [middle - wide, middle + wide];
}

/** How many values there are in each of some intervals: of equal length, or of equal ratio if `logarithmic`. */
export function histogram(values, [low, high], bins, logarithmic) {
  const to = logarithmic ? Math.log : (x) => x, back = logarithmic ? Math.exp : (x) => x;
  const first = to(low), width = (to(high) - first) / bins || 1;
  const counts = new Array(bins).fill(0);
  for (const value of values)
    if (value >= low && (value > 0 || !logarithmic)) ++counts[Math.min(bins - 1, Math.floor((to(value) - first) / width))];
  return counts.map((count, k) => ({ from: back(first + k * width), to: back(first + (k + 1) * width), count }));
}
