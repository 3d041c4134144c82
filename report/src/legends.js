import { css, fills, kShades, ofCategory, onScale, stops } from "./colors.js";
import { element, number } from "./elements.js";
import { isFlat } from "./mesh_values.js";

/** A strip of the colors from the least to the greatest value. */
export function scaleLegend(least, greatest, what) {
  const strip = element("span", { class: "strip", style: `background: linear-gradient(to right, ${stops.map(css).join(",")})` });
  return [`${what} ${number(least)}`, strip, number(greatest)];
}

/** The same for what may be one value, or none: not a number. */
export function valuesLegend(range, what) {
  if (range.some(Number.isNaN)) return [`${what}: no value is a finite number`];
  if (!isFlat(range)) return scaleLegend(...range, what);
  return [what, element("span", { class: "chip", style: `background: ${css(onScale(0.5))}` }), number((range[0] + range[1]) / 2)];
}

/** A chip for each category, if not too many. */
export function categoryLegend(names) {
  const most = fills.length * kShades;
  const chips = names.slice(0, most).flatMap((name, n) =>
    [element("span", { class: "chip", style: `background: ${css(ofCategory(n))}` }), number(name)]);
  return [...chips, ...(names.length > most ? [`... ${number(names[names.length - 1])}; colors repeat after ${most}`] : [])];
}
