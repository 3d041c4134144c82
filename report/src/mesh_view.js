// Millions of triangles on a canvas. The vertex shader fetches corners from textures, so that the mesh stays in memory
// once, whatever it is colored by; a triangle is found under the pointer by drawing its number into a single pixel.

const kWidth = 4096; // of textures

/** Cividis, nearly: readable with any color vision. From the least to the greatest. */
export const stops = [[0, 0.135, 0.305], [0.26, 0.305, 0.425], [0.485, 0.482, 0.473], [0.73, 0.68, 0.42], [0.995, 0.91, 0.27]];

const header = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
`;

const vertexShader = `${header}
uniform sampler2D points;
uniform usampler2D triangles;
uniform usampler2D numbers; // of the triangles, by which they may be colored
uniform vec4 view;          // scale and offset to clip space
uniform int mode;           // 0 angle, 1 area, 2 numbers as categories
uniform vec2 range;         // of the logarithms of areas
uniform bool picking;
flat out vec4 color;
out vec3 corner;

ivec2 at(int k) { return ivec2(k % ${kWidth}, k / ${kWidth}); }
vec2 point(uint k) { return texelFetch(points, at(int(k)), 0).xy; }

vec3 scale(float t) {
  const vec3 stops[5] = vec3[5](${stops.map((s) => `vec3(${s.map((x) => x.toFixed(3)).join(", ")})`).join(", ")});
  float s = clamp(t, 0.0, 1.0) * 4.0;
  int k = min(int(s), 3);
  return mix(stops[k], stops[k + 1], s - float(k));
}
vec3 category(uint n) {
  const vec3 all[7] = vec3[7](vec3(0.34, 0.71, 0.91), vec3(0.9, 0.62, 0.0), vec3(0.0, 0.62, 0.45), vec3(0.94, 0.89, 0.26),
                              vec3(0.0, 0.45, 0.7), vec3(0.84, 0.37, 0.0), vec3(0.8, 0.47, 0.65));
  float shade = 1.0 - 0.18 * float((n / 7u) % 4u);
  return all[n % 7u] * shade;
}
float angle(vec2 o, vec2 p, vec2 q) {
  vec2 u = p - o, v = q - o;
  return degrees(atan(abs(u.x * v.y - u.y * v.x), dot(u, v)));
}

void main() {
  int t = gl_VertexID / 3, k = gl_VertexID % 3;
  uvec4 v = texelFetch(triangles, at(t), 0);
  vec2 a = point(v.x), b = point(v.y), c = point(v.z);
  vec2 own = k == 0 ? a : k == 1 ? b : c;
  gl_Position = vec4(own * view.xy + view.zw, 0, 1);
  corner = vec3(k == 0, k == 1, k == 2);
  if (picking) {
    uint n = uint(t) + 1u;
    color = vec4(float(n & 255u), float((n >> 8) & 255u), float((n >> 16) & 255u), float(n >> 24)) / 255.0;
  } else if (mode == 0) {
    color = vec4(scale(min(angle(a, b, c), min(angle(b, c, a), angle(c, a, b))) / 60.0), 1);
  } else if (mode == 1) {
    float area = 0.5 * abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    color = vec4(scale((log(area) - range.x) / max(range.y - range.x, 1e-6)), 1);
  } else {
    color = vec4(category(texelFetch(numbers, at(t), 0).x), 1);
  }
}`;

const fragmentShader = `${header}
uniform bool picking;
flat in vec4 color;
in vec3 corner;
out vec4 made;
void main() {
  if (picking) { made = color; return; }
  // Edges, where triangles are large enough for them: width in pixels by how fast the coordinates change.
  vec3 change = fwidth(corner);
  vec3 near = smoothstep(vec3(0), change, corner);
  float edge = 1.0 - min(near.x, min(near.y, near.z));
  float height = 1.0 / max(change.x, max(change.y, change.z));  // the triangle's least one, in pixels
  float large = smoothstep(4.0, 16.0, height);
  made = vec4(mix(color.rgb, vec3(0.1), edge * large * 0.8), 1);
}`;

function program(gl) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

/** Rows of kWidth texels, the last one padded. */
function upload(gl, unit, texture, array, per, [internal, format, type]) {
  const rows = Math.max(1, Math.ceil(array.length / per / kWidth));
  const padded = new array.constructor(rows * kWidth * per);
  padded.set(array);
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl[internal], kWidth, rows, 0, gl[format], gl[type], padded);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
}

export const modes = { angle: 0, area: 1, number: 2 };

/** Draws `mesh` ({points, triangles}) on a canvas. */
export class MeshView {
  constructor(canvas, mesh) {
    this.canvas = canvas;
    this.count = mesh.triangles.length / 3;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true }));
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.program = program(gl);
    this.numbers = gl.createTexture();
    upload(gl, 0, gl.createTexture(), mesh.points, 2, ["RG32F", "RG", "FLOAT"]);
    upload(gl, 1, gl.createTexture(), mesh.triangles, 3, ["RGB32UI", "RGB_INTEGER", "UNSIGNED_INT"]);
    upload(gl, 2, this.numbers, new Uint32Array(1), 1, ["R32UI", "RED_INTEGER", "UNSIGNED_INT"]);
    gl.bindVertexArray(gl.createVertexArray());
    this.pixel = gl.createFramebuffer();
    const target = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, target);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, 1, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pixel);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, target);
    this.mode = modes.angle;
    this.range = [0, 1];
    this.transform = { k: 1, x: 0, y: 0 };
  }

  /** Colors by one number for each triangle. */
  setNumbers(numbers) {
    upload(this.gl, 2, this.numbers, numbers, 1, ["R32UI", "RED_INTEGER", "UNSIGNED_INT"]);
    this.mode = modes.number;
  }

  resize() {
    const scale = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * scale);
    this.canvas.height = Math.round(this.canvas.clientHeight * scale);
  }

  /** From the mesh's coordinates, in a square of side 2 around 0, to clip space. */
  view() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const unit = Math.min(w, h) / 2.1;
    const { k, x, y } = this.transform;
    return [(2 * unit * k) / w, (2 * unit * k) / h, (2 * (x + (w / 2) * k)) / w - 1, 1 - (2 * (y + (h / 2) * k)) / h];
  }

  run(picking, view) {
    const { gl } = this;
    gl.useProgram(this.program);
    const at = (name) => gl.getUniformLocation(this.program, name);
    ["points", "triangles", "numbers"].forEach((name, unit) => gl.uniform1i(at(name), unit));
    gl.uniform4fv(at("view"), view);
    gl.uniform1i(at("mode"), this.mode);
    gl.uniform2fv(at("range"), this.range);
    gl.uniform1i(at("picking"), picking ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * this.count);
  }

  draw() {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.run(false, this.view());
  }

  /** The triangle at a place of the canvas, in CSS pixels from its top left corner; -1 if there is none. */
  triangleAt(x, y) {
    const { gl } = this;
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const [sx, sy, ox, oy] = this.view();
    const px = (2 * x) / w - 1, py = 1 - (2 * y) / h;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pixel);
    gl.viewport(0, 0, 1, 1);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.run(true, [sx * w, sy * h, (ox - px) * w, (oy - py) * h]);
    const rgba = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    return rgba[0] + 256 * rgba[1] + 65536 * rgba[2] + 16777216 * rgba[3] - 1;
  }
}
