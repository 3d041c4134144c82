import { fills, kShades, stops } from "./colors.js";

export const kWidth = 4096; // of textures

const header = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
`;
const vec3 = (c) => `vec3(${c.map((x) => x.toFixed(3)).join(", ")})`;

const scale = `
uniform bool scaled;        // numbers are the bits of values on a scale; otherwise they are categories
uniform vec2 range;         // the ends of the scale
uniform int pass;           // 0 colors, 1 numbers of triangles as colors, 2 one triangle that stands out
`;

/** Fetches corners from textures, so that the mesh is in memory once, whatever it is colored by. */
export const triangleVertices = `${header}${scale}
uniform sampler2D points;
uniform usampler2D triangles;
uniform usampler2D numbers; // by which triangles or points may be colored
uniform usampler2D lookup;  // what stands for these numbers, if there is more than one
uniform vec4 view;          // scale and offset to clip space
uniform bool atPoints;      // what numbers are of
flat out vec4 color;
out float value;
out vec3 corner;

ivec2 at(int k) { return ivec2(k % ${kWidth}, k / ${kWidth}); }
vec2 point(uint k) { return texelFetch(points, at(int(k)), 0).xy; }

vec3 ofCategory(uint n) {
  const vec3 all[${fills.length}] = vec3[](${fills.map(vec3).join(", ")});
  return all[n % ${fills.length}u] * (1.0 - 0.18 * float((n / ${fills.length}u) % ${kShades}u));
}
void main() {
  int t = gl_VertexID / 3, k = gl_VertexID % 3;
  uvec4 v = texelFetch(triangles, at(t), 0);
  vec2 a = point(v.x), b = point(v.y), c = point(v.z);
  vec2 own = k == 0 ? a : k == 1 ? b : c;
  gl_Position = vec4(own * view.xy + view.zw, 0, 1);
  corner = vec3(k == 0, k == 1, k == 2);
  value = scaled ? uintBitsToFloat(texelFetch(numbers, at(atPoints ? int(v[k]) : t), 0).x) : 0.0;
  color = vec4(0);
  if (pass == 1) {
    uint n = uint(t) + 1u;
    color = vec4(float(n & 255u), float((n >> 8) & 255u), float((n >> 16) & 255u), float(n >> 24)) / 255.0;
  } else if (pass == 2) {
    color = vec4(${vec3([0.84, 0.37, 0])}, 1);
  } else if (!scaled) {
    uint n = texelFetch(numbers, at(t), 0).x;
    color = vec4(ofCategory(textureSize(lookup, 0).y > 1 || textureSize(lookup, 0).x > 1 ? texelFetch(lookup, at(int(n)), 0).x : n), 1);
  }
}`;

export const triangleFragments = `${header}${scale}
uniform bool edges;
flat in vec4 color;
in float value;
in vec3 corner;
out vec4 made;

vec3 onScale(float t) {
  const vec3 stops[${stops.length}] = vec3[](${stops.map(vec3).join(", ")});
  float s = clamp(t, 0.0, 1.0) * ${(stops.length - 1).toFixed(1)};
  int k = min(int(s), ${stops.length - 2});
  return mix(stops[k], stops[k + 1], s - float(k));
}
void main() {
  if (pass == 1) { made = color; return; }
  // Edges, where triangles are large enough for them: width in pixels by how fast the coordinates change.
  vec3 change = fwidth(corner);
  vec3 near = smoothstep(vec3(0), change, corner);
  float edge = 1.0 - min(near.x, min(near.y, near.z));
  float height = 1.0 / max(change.x, max(change.y, change.z));  // the triangle's least one, in pixels
  float large = pass == 2 || !edges ? 0.0 : smoothstep(4.0, 16.0, height);
  vec3 shown = !scaled || pass == 2 ? color.rgb : isnan(value) || isinf(value) ? vec3(0.85) : onScale((value - range.x) / max(range.y - range.x, 1e-30));
  made = vec4(mix(shown, vec3(0.1), edge * large * 0.8), 1);
}`;

/** A square from -1 to 1 with an image. */
export const imageVertices = `${header}
uniform vec4 view;
out vec2 place;
void main() {
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4((2.0 * place - 1.0) * view.xy + view.zw, 0, 1);
}`;

export const imageFragments = `${header}
uniform sampler2D image;
in vec2 place;
out vec4 made;
void main() {
  made = texture(image, place);
  if (made.a < 0.5) discard;
}`;
