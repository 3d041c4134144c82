// Millions of triangles on a canvas. A triangle is found under the pointer by drawing its number into a single pixel.

import { ofCategory, onScale } from "./colors.js";
import { kImages, levelFor, meansOf, numbersOf, rangesInSight } from "./mesh_levels.js";
import { meansOfCorners } from "./mesh_values.js";
import { imageFragments, imageVertices, kWidth, triangleFragments, triangleVertices } from "./shaders.js";

function program(gl, vertices, fragments) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertices], [gl.FRAGMENT_SHADER, fragments]]) {
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

function nearest(gl, unit, texture) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
}

/** Rows of kWidth texels; a single one if there is no more. */
function upload(gl, unit, texture, array, per, [internal, format, type]) {
  const texels = array.length / per, width = Math.min(Math.max(texels, 1), kWidth), rows = Math.max(1, Math.ceil(texels / width));
  const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  if (rows > most) throw new Error(`this browser's graphics hold at most ${most * kWidth} triangles or points`);
  nearest(gl, unit, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl[internal], width, rows, 0, gl[format], gl[type], null);
  const whole = Math.floor(texels / width), rest = texels - whole * width;
  const part = (row, height, texelsWide, from) => height > 0 && texelsWide > 0 && gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, texelsWide, height,
    gl[format], gl[type], array.subarray(from * per, (from + height * texelsWide) * per));
  part(0, whole, width, 0);
  part(whole, 1, rest, whole * width);
}

const kNumbers = ["R32UI", "RED_INTEGER", "UNSIGNED_INT"];
const kNone = new Uint32Array(1);

/** Draws `mesh` ({points, triangles, starts, areas, half}, sorted, in a square of side 2 around 0) on a canvas. */
export class MeshView {
  constructor(canvas, mesh) {
    this.canvas = canvas;
    this.edges = true;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true }));
    if (!gl) throw new Error("this browser has no WebGL 2");
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.program = program(gl, triangleVertices, triangleFragments);
    this.imageProgram = program(gl, imageVertices, imageFragments);
    [this.points, this.triangles, this.numbers, this.lookup, this.image] = Array.from({ length: 5 }, () => gl.createTexture());
    gl.bindVertexArray(gl.createVertexArray());
    this.pixel = gl.createFramebuffer();
    const target = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, target);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, 1, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pixel);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, target);
    this.transform = { k: 1, x: 0, y: 0 };
    this.show(mesh);
    this.byCategories(kNone);
  }

  /** Another mesh, in the same square; its colors are to be told next. */
  show(mesh) {
    upload(this.gl, 0, this.points, mesh.points, 2, ["RG32F", "RG", "FLOAT"]);
    upload(this.gl, 1, this.triangles, mesh.triangles, 3, ["RGB32UI", "RGB_INTEGER", "UNSIGNED_INT"]);
    Object.assign(this, { mesh, marked: -1, shown: null });
  }

  /** Colors triangles by their values (Float32Array) on a scale between the ends of `range`, or linearly by those at points. What is not
   * a finite number is gray. */
  byValues(values, range, atPoints = false) {
    this.color(values, new Uint32Array(values.buffer, values.byteOffset, values.length), range, kNone, atPoints);
  }

  /** Colors triangles by numbers from 0 (Uint32Array), or by what `lookup` has for these. */
  byCategories(numbers, lookup = kNone) {
    this.color(numbers, numbers, null, lookup);
  }

  color(shown, bits, range, lookup, atPoints = false) {
    if (shown !== this.shown) {
      this.cells = {};
      upload(this.gl, 2, this.numbers, bits, 1, kNumbers);
    }
    upload(this.gl, 3, this.lookup, lookup, 1, kNumbers);
    Object.assign(this, { shown, atPoints, range, shownLookup: lookup.length > 1 ? lookup : null, imageLevel: null });
  }

  resize() {
    const scale = window.devicePixelRatio || 1;
    const width = Math.round(this.canvas.clientWidth * scale), height = Math.round(this.canvas.clientHeight * scale);
    if (this.canvas.width === width && this.canvas.height === height) return;
    Object.assign(this.canvas, { width, height });
  }

  /** Pixels of the screen in a unit. */
  unit() {
    const [x, y] = this.mesh.half;
    return (Math.min(this.canvas.clientWidth / Math.max(x, 0.05), this.canvas.clientHeight / Math.max(y, 0.05)) / 2.1) * this.transform.k;
  }

  /** From the mesh's coordinates to clip space. */
  view() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const { k, x, y } = this.transform;
    const unit = this.unit();
    return [(2 * unit) / w, (2 * unit) / h, (2 * (x + (w / 2) * k)) / w - 1, 1 - (2 * (y + (h / 2) * k)) / h];
  }

  /** The color of a cell of an image, null where there is nothing. */
  colorOf(value) {
    if (this.range) return !Number.isFinite(value) ? null : onScale((value - this.range[0]) / Math.max(this.range[1] - this.range[0], 1e-30));
    return value < 0 ? null : ofCategory(this.shownLookup ? this.shownLookup[value] : value);
  }

  cellsOf(level) {
    const { mesh } = this;
    const shown = this.atPoints ? meansOfCorners(this.shown, mesh.triangles) : this.shown;
    this.cells[level] ??= this.range ? meansOf(mesh, level, shown, mesh.areas) : numbersOf(mesh, level, shown, mesh.areas);
    return this.cells[level];
  }

  makeImage(level) {
    if (this.imageLevel === level) return;
    const { gl } = this;
    const cells = this.cellsOf(level);
    const texels = new Uint8Array(4 * cells.length);
    cells.forEach((value, i) => {
      const color = this.colorOf(value);
      if (color) texels.set([255 * color[0], 255 * color[1], 255 * color[2], 255], 4 * i);
    });
    nearest(gl, 4, this.image);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, kImages[level], kImages[level], 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    this.imageLevel = level;
  }

  run(pass, view, ranges) {
    const { gl } = this;
    gl.useProgram(this.program);
    const at = (name) => gl.getUniformLocation(this.program, name);
    ["points", "triangles", "numbers", "lookup"].forEach((name, unit) => gl.uniform1i(at(name), unit));
    gl.uniform4fv(at("view"), view);
    gl.uniform1i(at("scaled"), this.range ? 1 : 0);
    gl.uniform1i(at("atPoints"), this.atPoints ? 1 : 0);
    gl.uniform1i(at("edges"), this.edges ? 1 : 0);
    gl.uniform2fv(at("range"), this.range ?? [0, 1]);
    gl.uniform1i(at("pass"), pass);
    for (const [from, to] of ranges) gl.drawArrays(gl.TRIANGLES, 3 * from, 3 * (to - from));
  }

  draw() {
    const { gl } = this;
    const view = this.view();
    const level = levelFor(this.unit() * (window.devicePixelRatio || 1));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (level !== null) {
      this.makeImage(level);
      gl.useProgram(this.imageProgram);
      gl.uniform1i(gl.getUniformLocation(this.imageProgram, "image"), 4);
      gl.uniform4fv(gl.getUniformLocation(this.imageProgram, "view"), view);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    const [sx, sy, ox, oy] = view;
    const ranges = rangesInSight(this.mesh.starts, [(-1 - ox) / sx, (-1 - oy) / sy, (1 - ox) / sx, (1 - oy) / sy], level);
    this.run(0, view, ranges);
    if (this.marked >= 0) this.run(2, view, [[this.marked, this.marked + 1]]);
    this.drawn = ranges.reduce((sum, [from, to]) => sum + to - from, 0);
  }

  /** The place in the mesh's coordinates of one on the canvas, in CSS pixels from its top left corner. */
  placeOf(x, y) {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const [sx, sy, ox, oy] = this.view();
    return [((2 * x) / w - 1 - ox) / sx, (1 - (2 * y) / h - oy) / sy];
  }

  /** The triangle at a place of the canvas; -1 if there is none. */
  triangleAt(x, y) {
    const { gl } = this;
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const [sx, sy, ox, oy] = this.view();
    const [px, py] = [(2 * x) / w - 1, 1 - (2 * y) / h];
    const [mx, my] = this.placeOf(x, y);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pixel);
    gl.viewport(0, 0, 1, 1);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.run(1, [sx * w, sy * h, (ox - px) * w, (oy - py) * h], rangesInSight(this.mesh.starts, [mx, my, mx, my], null));
    const rgba = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    return rgba[0] + 256 * rgba[1] + 65536 * rgba[2] + 16777216 * rgba[3] - 1;
  }
}
