// What driftmesh put into the page: values and arrays, each compressed by zlib, as base64.

async function bytesOf(element) {
  const packed = Uint8Array.from(atob(element.textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const arrayTypes = { Float32: Float32Array, Uint16: Uint16Array, Uint32: Uint32Array, Int32: Int32Array };

/** All runs, as {record, trace, name}; trace is null if there is none. */
export async function readRuns() {
  const read = async (element) =>
    ({ ...JSON.parse(new TextDecoder().decode(await bytesOf(element))), name: element.dataset.run });
  return Promise.all([...document.querySelectorAll("script[data-run]")].map(read));
}

/** The mesh: {name, points, triangles, columns: {name: array}}, or null. */
export async function readMesh() {
  const elements = [...document.querySelectorAll("script[data-mesh]")];
  if (elements.length === 0) return null;
  const mesh = { name: elements[0].dataset.name, columns: {} };
  for (const element of elements) {
    const array = new arrayTypes[element.dataset.type](await bytesOf(element));
    const column = element.dataset.mesh;
    if (column === "points" || column === "triangles") mesh[column] = array;
    else mesh.columns[column] = array;
  }
  return mesh;
}
