// Colors that can be told apart with any color vision.

/** Okabe and Ito 2008. */
export const colors = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#000000"];

/** Cividis, nearly: from the least to the greatest, red, green and blue from 0 to 1. */
export const stops = [[0, 0.135, 0.305], [0.26, 0.305, 0.425], [0.485, 0.482, 0.473], [0.73, 0.68, 0.42], [0.995, 0.91, 0.27]];

/** What areas are filled with: light enough for the edges upon them. */
export const fills = [[0.34, 0.71, 0.91], [0.9, 0.62, 0], [0, 0.62, 0.45], [0.94, 0.89, 0.26], [0, 0.45, 0.7], [0.84, 0.37, 0], [0.8, 0.47, 0.65]];
export const kShades = 4;

/** The color of a value from 0 to 1. */
export function onScale(t) {
  const s = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(s), stops.length - 2);
  return stops[k].map((from, c) => from + (stops[k + 1][c] - from) * (s - k));
}

/** The color of a number that stands for a category, such as a rank. They repeat after 28. */
export function ofCategory(n) {
  const shade = 1 - 0.18 * (Math.floor(n / fills.length) % kShades);
  return fills[n % fills.length].map((c) => c * shade);
}

export const css = (color) => `rgb(${color.map((c) => Math.round(255 * c)).join(",")})`;
