// Triangles for the graphics card: three separate corners each, so that every triangle has its own tone and edges. Each set is one buffer geometry.
import { BufferAttribute, BufferGeometry, Box3, Sphere, Vector3 } from "three";

/** Triangles in drawing order, and the item (triangle of the report, polygon of a cut) of each triangle. */
export class TriangleSet {
  /** positions: f32[9 m]; flags: u8[m], bits 0-2 are edges; item: u32[m], index of the item that defines the tone. */
  constructor(positions, flags, item) {
    this.n = item.length;
    this.positions = positions;
    this.item = item;
    this.data = new Uint16Array(this.n * 6); // for each corner: tone, flags
    for (let t = 0; t < this.n; ++t) for (let c = 0; c < 3; ++c) this.data[6 * t + 2 * c + 1] = flags[t];
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", new BufferAttribute(positions, 3));
    this.data_attribute = new BufferAttribute(this.data, 2);
    this.geometry.setAttribute("data", this.data_attribute);
    this.geometry.boundingSphere = sphere_of(positions);
  }

  /** Sets the tones by item. */
  set_tones(tones) {
    const { data, item } = this;
    for (let t = 0; t < this.n; ++t) {
      const tone = tones[item[t]];
      data[6 * t] = tone;
      data[6 * t + 2] = tone;
      data[6 * t + 4] = tone;
    }
    this.data_attribute.needsUpdate = true;
  }

  /** Draws only these ranges of triangles. Adjacent ranges are joined to reduce the number of calls; returns the joined ranges. */
  show_ranges(ranges) {
    const joined = [];
    for (const [from, to] of ranges) {
      if (to <= from) continue;
      if (joined.length && joined[joined.length - 1][1] === from) joined[joined.length - 1][1] = to;
      else joined.push([from, to]);
    }
    this.geometry.clearGroups();
    for (const [from, to] of joined) this.geometry.addGroup(3 * from, 3 * (to - from), 0);
    return joined;
  }

  corners(t) {
    return [0, 1, 2].map((c) => new Vector3().fromArray(this.positions, 9 * t + 3 * c));
  }

  dispose() {
    this.geometry.dispose();
    this.thin?.dispose();
  }
}

export function box_of(positions, from = 0, to = positions.length) {
  const box = new Box3();
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = from; k < to; k += 3)
    for (let c = 0; c < 3; ++c) {
      const x = positions[k + c];
      if (x < low[c]) low[c] = x;
      if (x > high[c]) high[c] = x;
    }
  if (low[0] <= high[0]) box.set(new Vector3(...low), new Vector3(...high));
  return box;
}

function sphere_of(positions) {
  const box = box_of(positions);
  return box.isEmpty() ? new Sphere(new Vector3(), 0) : box.getBoundingSphere(new Sphere());
}

const k_wall_flag = 8;
const k_closed = 0.2; // relative difference of volumes below which a surface counts as closed and consistently oriented

/** Returns 1 if normals of triangles with k_wall_flag point out of the enclosed volume, -1 if they point inwards, and 0 if no volume is enclosed (open surface, mixed orientations). */
function outward_of(positions, flags) {
  // The volume by the divergence of (x, 0, 0), (0, y, 0) and (0, 0, z): three equal numbers for a closed surface with consistent orientation.
  const volumes = [0, 0, 0];
  for (let t = 0, k = 0; t < flags.length; ++t, k += 9) {
    if (!(flags[t] & k_wall_flag)) continue;
    for (let c = 0; c < 3; ++c) {
      const a = (c + 1) % 3, b = (c + 2) % 3;
      const area = (positions[k + 3 + a] - positions[k + a]) * (positions[k + 6 + b] - positions[k + b]) - (positions[k + 3 + b] - positions[k + b]) * (positions[k + 6 + a] - positions[k + a]);
      volumes[c] += (area * (positions[k + c] + positions[k + 3 + c] + positions[k + 6 + c])) / 6;
    }
  }
  const least = Math.min(...volumes), greatest = Math.max(...volumes);
  if (least * greatest <= 0 || greatest - least > k_closed * Math.max(Math.abs(least), Math.abs(greatest))) return 0;
  return Math.sign(least);
}

/** Returns the surface, sorted by patch: ranges[p] = [first triangle, end] in the order of the set; outward is the result of outward_of for patches that are walls. */
export function surface_set(surface, patches) {
  const { n, points, triangles, patch, edges } = surface;
  const n_patches = patches.length;
  const start = new Uint32Array(n_patches + 1);
  for (const p of patch) ++start[p + 1];
  for (let p = 0; p < n_patches; ++p) start[p + 1] += start[p];
  const ranges = Array.from({ length: n_patches }, (_, p) => [start[p], start[p + 1]]);
  const next = start.slice();
  const positions = new Float32Array(9 * n), flags = new Uint8Array(n), item = new Uint32Array(n);
  for (let t = 0; t < n; ++t) {
    const slot = next[patch[t]]++;
    item[slot] = t;
    flags[slot] = (edges[t] & 7) | (patches[patch[t]].kind === "wall" ? k_wall_flag : 0);
    for (let c = 0; c < 3; ++c) {
      const from = 3 * triangles[3 * t + c], to = 9 * slot + 3 * c;
      positions[to] = points[from];
      positions[to + 1] = points[from + 1];
      positions[to + 2] = points[from + 2];
    }
  }
  const set = new TriangleSet(positions, flags, item);
  set.ranges = ranges;
  set.outward = outward_of(positions, flags);
  set.boxes = ranges.map(([from, to]) => box_of(positions, 9 * from, 9 * to));
  return set;
}

const k_thin_cells = 220; // grid cells of a thinned set along the longest side of the bodies
const k_thin_cells_around = 60; // the same for surroundings such as a farfield
const k_most_cells = 1 << 17; // along one axis: three such numbers can be packed into one number

/** Returns a thinned surface: the points of each cell of a grid are merged at their mean position. The result has some ten thousand triangles for any surface, sorted by
 *  patch as in surface_set. Tones are by item of the surface. */
export function thin_set(surface, patches, set) {
  const { n, points, triangles, patch } = surface;
  const bodies = new Box3();
  set.boxes.forEach((box, p) => patches[p].is_of_body && bodies.union(box));
  const longest = (box) => Math.max(...box.getSize(new Vector3()).toArray(), 1e-12);
  const cell_of = set.boxes.map((box, p) => (patches[p].is_of_body && !bodies.isEmpty() ? longest(bodies) / k_thin_cells : box.isEmpty() ? 1 : longest(box) / k_thin_cells_around));
  // Each point belongs to the grid of the first patch that uses it, so that patches stay connected.
  const cluster = new Int32Array(points.length / 3).fill(-1);
  const known = new Map();
  const sums = []; // x, y, z, number of points of each cluster
  for (let t = 0; t < n; ++t) {
    const size = cell_of[patch[t]];
    for (let c = 3 * t; c < 3 * t + 3; ++c) {
      const v = triangles[c];
      if (cluster[v] >= 0) continue;
      const at = [0, 1, 2].map((axis) => ((Math.floor(points[3 * v + axis] / size) % k_most_cells) + k_most_cells) % k_most_cells);
      const key = (at[0] * k_most_cells + at[1]) * k_most_cells + at[2];
      let id = known.get(key);
      if (id === undefined) {
        known.set(key, (id = sums.length / 4));
        sums.push(0, 0, 0, 0);
      }
      cluster[v] = id;
      for (let axis = 0; axis < 3; ++axis) sums[4 * id + axis] += points[3 * v + axis];
      sums[4 * id + 3] += 1;
    }
  }
  const middles = new Float32Array((3 * sums.length) / 4);
  for (let id = 0; 4 * id < sums.length; ++id) for (let axis = 0; axis < 3; ++axis) middles[3 * id + axis] = sums[4 * id + axis] / sums[4 * id + 3];
  const source = [], corners = [];
  for (let t = 0; t < n; ++t) {
    const a = cluster[triangles[3 * t]], b = cluster[triangles[3 * t + 1]], c = cluster[triangles[3 * t + 2]];
    if (a === b || b === c || c === a) continue;
    source.push(t);
    corners.push(a, b, c);
  }
  const thin = surface_set({ n: source.length, points: middles, triangles: corners, patch: source.map((t) => patch[t]), edges: new Uint8Array(source.length) }, patches);
  for (let t = 0; t < thin.n; ++t) thin.item[t] = source[thin.item[t]];
  return thin;
}

/** Returns polygons of a cut as triangle fans (a plane through a convex cell gives a convex polygon); inner edges of a fan are not drawn. */
export function cut_set(cut) {
  const { n, points, first } = cut;
  let n_triangles = 0;
  for (let k = 0; k < n; ++k) n_triangles += Math.max(first[k + 1] - first[k] - 2, 0);
  const positions = new Float32Array(9 * n_triangles), flags = new Uint8Array(n_triangles), item = new Uint32Array(n_triangles);
  let t = 0;
  for (let k = 0; k < n; ++k)
    for (let c = first[k] + 1; c + 1 < first[k + 1]; ++c, ++t) {
      [first[k], c, c + 1].forEach((corner, j) => positions.set(points.subarray(3 * corner, 3 * corner + 3), 9 * t + 3 * j));
      flags[t] = (c === first[k] + 1 ? 1 : 0) | 2 | (c + 2 === first[k + 1] ? 4 : 0);
      item[t] = k;
    }
  return new TriangleSet(positions, flags, item);
}

/** Returns the intersection of a ray with the plane of triangle t; the centre of the triangle if the ray is parallel. */
export function point_on(set, t, origin, direction) {
  const [a, b, c] = set.corners(t);
  const normal = b.clone().sub(a).cross(c.clone().sub(a));
  const along = normal.dot(direction);
  if (Math.abs(along) < 1e-12 * normal.length()) return a.add(b).add(c).divideScalar(3);
  return origin.clone().addScaledVector(direction, normal.dot(a.clone().sub(origin)) / along);
}

/** Returns the triangle of the given ranges whose centre is nearest to a point: {t, distance, normal, size}; null if there is none. */
export function nearest_triangle(set, point, ranges) {
  let best = -1, least = Infinity;
  const p = set.positions;
  for (const [from, to] of ranges)
    for (let t = from; t < to; ++t) {
      const k = 9 * t;
      const x = (p[k] + p[k + 3] + p[k + 6]) / 3 - point.x, y = (p[k + 1] + p[k + 4] + p[k + 7]) / 3 - point.y, z = (p[k + 2] + p[k + 5] + p[k + 8]) / 3 - point.z;
      const square = x * x + y * y + z * z;
      if (square < least) {
        least = square;
        best = t;
      }
    }
  if (best < 0) return null;
  const [a, b, c] = set.corners(best);
  const size = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a));
  const normal = b.sub(a).cross(c.sub(a));
  if (normal.length() > 0) normal.normalize();
  else normal.set(0, 0, 1);
  return { t: best, distance: Math.sqrt(least), normal, size };
}

/** Returns the length to the first triangle along a ray that starts at origin + least * direction; Infinity if there is none. Moller-Trumbore, both sides. */
export function first_hit(set, origin, direction, ranges, least) {
  const p = set.positions;
  const [ox, oy, oz] = origin.toArray(), [dx, dy, dz] = direction.toArray();
  let best = Infinity;
  for (const [from, to] of ranges)
    for (let k = 9 * from; k < 9 * to; k += 9) {
      const e1x = p[k + 3] - p[k], e1y = p[k + 4] - p[k + 1], e1z = p[k + 5] - p[k + 2];
      const e2x = p[k + 6] - p[k], e2y = p[k + 7] - p[k + 1], e2z = p[k + 8] - p[k + 2];
      const hx = dy * e2z - dz * e2y, hy = dz * e2x - dx * e2z, hz = dx * e2y - dy * e2x;
      const a = e1x * hx + e1y * hy + e1z * hz;
      if (a === 0) continue;
      const sx = ox - p[k], sy = oy - p[k + 1], sz = oz - p[k + 2];
      const u = (sx * hx + sy * hy + sz * hz) / a;
      if (u < 0 || u > 1) continue;
      const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
      const v = (dx * qx + dy * qy + dz * qz) / a;
      if (v < 0 || u + v > 1) continue;
      const length = (e2x * qx + e2y * qy + e2z * qz) / a;
      if (length > least && length < best) best = length;
    }
  return best;
}
