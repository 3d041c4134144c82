// What driftmesh put into the page: values and arrays, each compressed by zlib, as base64.

const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const valueOf = new Uint8Array(128);
for (let k = 0; k < 64; ++k) valueOf[digits.charCodeAt(k)] = k;

/** The bytes of base64 (RFC 4648). By hand, since atob makes strings of them: a mesh has a hundred million. */
export function unpacked(text) {
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array((text.length / 4) * 3);
  const value = (i) => valueOf[text.charCodeAt(i)];
  for (let i = 0, at = 0; i < text.length; i += 4, at += 3) {
    const three = (value(i) << 18) | (value(i + 1) << 12) | (value(i + 2) << 6) | value(i + 3);
    bytes[at] = three >> 16;
    bytes[at + 1] = three >> 8;
    bytes[at + 2] = three;
  }
  return bytes.subarray(0, bytes.length - padding);
}

/** The compressed bytes of an element, which goes: its text is as large, and nobody asks for it again. */
function packedOf(element) {
  const packed = unpacked(element.textContent);
  element.remove();
  return packed;
}

const inflated = (packed) => new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
const bytesOf = (element) => inflated(packedOf(element));

const arrayTypes = { Float32: Float32Array, Uint32: Uint32Array, Int32: Int32Array };

/** All runs, as {record, timeline, name}; timeline is null if there is none. */
export async function readRuns() {
  const read = async (element) =>
    ({ ...JSON.parse(new TextDecoder().decode(await bytesOf(element))), name: element.dataset.run });
  return Promise.all([...document.querySelectorAll("script[data-run]")].map(read));
}

/** The mesh: {name, middle, points, triangles, columns: {name: array}}, or null. Points are seen from the middle. */
export async function readMesh() {
  const elements = [...document.querySelectorAll("script[data-mesh]")];
  if (elements.length === 0) return null;
  const { name, middle } = elements[0].dataset;
  const mesh = { name, middle: middle.split(" ").map(Number), columns: {} };
  for (const element of elements) {
    const array = new arrayTypes[element.dataset.type](await bytesOf(element));
    const column = element.dataset.mesh;
    if (column === "points" || column === "triangles") mesh[column] = array;
    else mesh.columns[column] = array;
  }
  return mesh;
}

const numbersIn = (text) => text.split(" ").map(Number);

/** Frames of one field: {name, field, atPoints, middle, box, range, frames: [{mesh, time}], mesh(k), values(k)}, or null. The arrays of mesh
 * or frame k are promised when they are asked for; time is null where it is not known. Points and the box are seen from the middle. */
export function readSeries() {
  const about = document.querySelector("script[data-series]");
  if (!about) return null;
  const { series: name, field, at, middle, box, range } = about.dataset;
  const elementsOf = (kind) => [...document.querySelectorAll(`script[data-frame=${kind}]`)];
  const frames = elementsOf("values").map(({ dataset: { of, time } }) => ({ mesh: Number(of), time: time === undefined ? null : Number(time) }));
  const [points, triangles, values] = ["points", "triangles", "values"].map((kind) => elementsOf(kind).map(packedOf));
  const [left, bottom, right, top] = numbersIn(box);
  return { name, field, atPoints: at === "points", middle: numbersIn(middle), box: [[left, bottom], [right, top]], range: numbersIn(range), frames,
    mesh: async (k) => ({ points: new Float32Array(await inflated(points[k])), triangles: new Uint32Array(await inflated(triangles[k])) }),
    values: async (k) => new Float32Array(await inflated(values[k])) };
}
