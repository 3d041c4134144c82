/** A new element with attributes and children; text becomes text nodes. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

export function section(title, note) {
  const made = element("section", {}, element("h2", {}, title));
  if (note) made.append(element("p", { class: "note" }, note));
  return made;
}

/** Four significant digits unless told otherwise, and whole numbers with separators. */
export function number(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "";
  if (Number.isInteger(x)) return x.toLocaleString("en-US");
  return Number(x.toPrecision(digits)).toLocaleString("en-US", { maximumFractionDigits: 12 });
}

export const percent = (x) => (x === null || x === undefined ? "" : `${(100 * x).toFixed(1)} %`);
