// Shaders: triangles with one tone each, their edges, picking, markers.
import { DataTexture, DoubleSide, GLSL3, NearestFilter, RGBAFormat, ShaderMaterial, UnsignedByteType } from "three";

const k_palette_width = 256;

/** Returns a palette as a texture with rows of 256 colours. */
export function palette_texture(bytes) {
  const n = bytes.length / 4;
  const rows = Math.max(1, Math.ceil(n / k_palette_width));
  const padded = new Uint8Array(rows * k_palette_width * 4);
  padded.set(bytes);
  const texture = new DataTexture(padded, k_palette_width, rows, RGBAFormat, UnsignedByteType);
  texture.minFilter = NearestFilter;
  texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

// The depth is the logarithm of the distance, so that a boundary layer of 1e-6 m and a farfield of 1e3 m are correct in one picture.
const k_depth = `gl_FragDepth = clamp(log2(v_w / near) / log2(far / near), 0.0, 1.0);`;

const k_vertex = `
precision highp float;
in vec2 data;
uniform vec4 clip;
out vec3 v_view;
out vec3 v_corner;
out float v_clip;
out float v_w;
flat out uint v_tone;
flat out uint v_edges;
flat out uint v_id;
void main() {
  int corner = gl_VertexID % 3;
  v_corner = vec3(corner == 0, corner == 1, corner == 2);
  v_id = uint(gl_VertexID / 3);
  v_tone = uint(data.x + 0.5);
  v_edges = uint(data.y + 0.5);
  v_clip = dot(clip.xyz, position) - clip.w;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  v_view = view.xyz;
  gl_Position = projectionMatrix * view;
  v_w = gl_Position.w;
}`;

const k_inputs = `
precision highp float;
precision highp int;
uniform float near;
uniform float far;
in vec3 v_view;
in vec3 v_corner;
in float v_clip;
in float v_w;
flat in uint v_tone;
flat in uint v_edges;
flat in uint v_id;
`;

// The shading stays between 0.68 and 1, so that colours remain comparable with the colour bar. Edges fade where triangles become thinner than a few pixels:
// a dense mesh remains readable instead of black.
const k_fragment = `${k_inputs}
uniform sampler2D palette;
uniform float shading;
uniform float edge_strength;
uniform vec3 edge_colour;
uniform float fade_together;
uniform float outward;
out vec4 colour;
float least_room;
float edge(float distance_to, float room, uint bit) {
  return (v_edges & bit) != 0u ? (1.0 - smoothstep(0.35, 1.15, distance_to * room)) * smoothstep(1.5, 9.0, mix(room, least_room, fade_together)) : 0.0;
}
void main() {
  vec3 normal = cross(dFdx(v_view), dFdy(v_view));
  vec3 slope_x = dFdx(v_corner), slope_y = dFdy(v_corner);
  vec3 room = inversesqrt(max(slope_x * slope_x + slope_y * slope_y, vec3(1e-30))); // heights of the triangle, pixels
  least_room = min(min(room.x, room.y), room.z);
  float line = max(max(edge(v_corner.z, room.z, 1u), edge(v_corner.x, room.x, 2u)), edge(v_corner.y, room.y, 4u));
  if (v_clip > 0.0) discard;
  bool is_inside = outward != 0.0 && (v_edges & 8u) != 0u && gl_FrontFacing == (outward < 0.0);
  vec3 base = texelFetch(palette, ivec2(v_tone & 255u, v_tone >> 8), 0).rgb;
  // Inside the body, visible through a cut: duller colours, which distinguish it from the outside and from cells.
  if (is_inside) base = mix(base, vec3(0.42), 0.6);
  float size = length(normal);
  normal = size > 0.0 ? normal / size : vec3(0.0, 0.0, 1.0);
  float facing = abs(dot(normal, normalize(v_view)));
  float side = 0.5 + 0.5 * dot(normal, normalize(vec3(-0.35, 0.75, 0.55)));
  float light = mix(1.0, 0.68 + 0.24 * facing + 0.14 * side, shading);
  colour = vec4(mix(base * light, edge_colour, line * edge_strength), 1.0);
  ${k_depth}
}`;

const k_pick_fragment = `${k_inputs}
uniform float id_offset;
out vec4 colour;
void main() {
  if (v_clip > 0.0) discard;
  uint id = v_id + uint(id_offset) + 1u;
  colour = vec4(float(id & 255u), float((id >> 8) & 255u), float((id >> 16) & 255u), float(id >> 24)) / 255.0;
  ${k_depth}
}`;

/** Returns the uniforms that the drawing material and the picking material of a set share. */
export function set_uniforms() {
  return {
    palette: { value: null },
    clip: { value: [0, 0, 0, 1] }, // points with dot(xyz, position) <= w are drawn
    near: { value: 1 },
    far: { value: 2 },
    shading: { value: 1 },
    edge_strength: { value: 0.55 },
    fade_together: { value: 1 }, // 0: long edges of slender triangles (cells of a layer) stay visible; 1: they fade with the short edges
    outward: { value: 0 }, // orientation of the wall normals: 1 out of the body, -1 into the body, 0 unknown
    edge_colour: { value: [0.1, 0.12, 0.15] },
    id_offset: { value: 0 },
  };
}

export function draw_material(uniforms) {
  return new ShaderMaterial({ glslVersion: GLSL3, uniforms, vertexShader: k_vertex, fragmentShader: k_fragment, side: DoubleSide });
}

export function pick_material(uniforms) {
  return new ShaderMaterial({ glslVersion: GLSL3, uniforms, vertexShader: k_vertex, fragmentShader: k_pick_fragment, side: DoubleSide });
}

/** Discs of constant size on the screen, visible through all objects. */
export function marker_material() {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    uniforms: { pixels: { value: 11 } },
    vertexShader: `
in vec3 colour_of;
uniform float pixels;
out vec3 v_colour;
void main() {
  v_colour = colour_of;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = pixels;
}`,
    fragmentShader: `
precision highp float;
in vec3 v_colour;
out vec4 colour;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  float soft = fwidth(r);
  vec3 inside = mix(v_colour, vec3(1.0), smoothstep(0.68 - soft, 0.68, r));
  colour = vec4(inside, 0.92 * (1.0 - smoothstep(1.0 - 1.5 * soft, 1.0, r)));
}`,
  });
}
