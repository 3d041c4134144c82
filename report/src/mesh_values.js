// Figures of triangles. Pure functions.

/** Moved and scaled into a square of side 2. In place; returns {length, middle, half}: of a unit, and of
 * all, in the former lengths; and half of the sides of all in the new ones. */
export function intoSquare(points) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    const d = i & 1;
    if (points[i] < low[d]) low[d] = points[i];
    if (points[i] > high[d]) high[d] = points[i];
  }
  const length = Math.max(high[0] - low[0], high[1] - low[1]) / 2 || 1;
  const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  for (let i = 0; i < points.length; ++i) points[i] = (points[i] - middle[i & 1]) / length;
  return { length, middle, half: [(high[0] - low[0]) / 2 / length, (high[1] - low[1]) / 2 / length] };
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

/** How many values there are in each of some intervals: of equal length, or of equal ratio if `logarithmic`. */
export function histogram(values, [low, high], bins, logarithmic) {
  const to = logarithmic ? Math.log : (x) => x, back = logarithmic ? Math.exp : (x) => x;
  const first = to(low), width = (to(high) - first) / bins || 1;
  const counts = new Array(bins).fill(0);
  for (const value of values)
    if (value >= low && (value > 0 || !logarithmic)) ++counts[Math.min(bins - 1, Math.floor((to(value) - first) / width))];
  return counts.map((count, k) => ({ from: back(first + k * width), to: back(first + (k + 1) * width), count }));
}
