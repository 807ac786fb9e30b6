// Small synthetic reports: an ellipsoid with a wing in a farfield, cuts through its layer, a series. With all that has once gone wrong in pages: names that
// look like markup, fields without values, limits outside of the bar, patches without triangles.
import { Blob } from "./pack_page.mjs";

export const k_nasty = 'wing "left" <script>alert(1)</script> & \u00fc\u7ffc\u2708';
const k_no_limits = { hard: null, target: null, usual: null };

/** Points and triangles of an ellipsoid, (r cos) in rings; outward orientation. */
function ellipsoid(center, radii, n_along, n_around) {
  const points = [], triangles = [];
  for (let i = 0; i <= n_along; ++i)
    for (let j = 0; j < n_around; ++j) {
      const a = (Math.PI * i) / n_along, b = (2 * Math.PI * j) / n_around;
      points.push([center[0] - radii[0] * Math.cos(a), center[1] + radii[1] * Math.sin(a) * Math.cos(b), center[2] + radii[2] * Math.sin(a) * Math.sin(b)]);
    }
  const edges = [];
  for (let i = 0; i < n_along; ++i)
    for (let j = 0; j < n_around; ++j) {
      const a = i * n_around + j, b = i * n_around + ((j + 1) % n_around), c = a + n_around, d = b + n_around;
      if (i > 0) {
        triangles.push([a, b, d]);
        edges.push(i === n_along - 1 ? 7 : 3); // the diagonal d-a of a quadrilateral is no edge
      }
      if (i < n_along - 1) {
        triangles.push([a, d, c]);
        edges.push(i === 0 ? 7 : 6);
      }
    }
  return { points, triangles, edges };
}

function surface_of(parts, origin, blob) {
  const points = [], triangles = [], patch = [], edges = [];
  parts.forEach((part, p) => {
    const first = points.length / 3;
    for (const point of part.points) points.push(...point.map((x, k) => x - origin[k]));
    part.triangles.forEach((triangle, t) => {
      triangles.push(...triangle.map((corner) => corner + first));
      patch.push(p);
      edges.push(part.edges[t]);
    });
  });
  const n = patch.length;
  const values = (f) => {
    const list = new Float32Array(n);
    for (let t = 0; t < n; ++t) list[t] = f(t, patch[t], points[3 * triangles[3 * t]] + origin[0]);
    return list;
  };
  const field = (name, title, unit, list, more) => {
    const finite = [...list].filter(Number.isFinite);
    return { name, title, unit, values: blob.add(list), min: finite.length ? finite.reduce((a, b) => Math.min(a, b)) : null, max: finite.length ? finite.reduce((a, b) => Math.max(a, b)) : null, is_log: false, low_is_bad: false, limits: k_no_limits, ...more };
  };
  return {
    n,
    counts: parts.map((_, p) => patch.reduce((sum, q) => sum + (q === p), 0)),
    surface: {
      shown: n,
      total: 2 * n,
      points: blob.add(new Float32Array(points)),
      triangles: blob.add(new Uint32Array(triangles)),
      patch: blob.add(new Uint16Array(patch)),
      edges: blob.add(new Uint8Array(edges)),
      fields: [
        field("edge_length", "edge length", "m", values((t, p, x) => 0.01 * 10 ** (1.5 * Math.sin(x))), { is_log: true }),
        field("skew", "skew <b>angle</b>", "deg", values((t, p, x) => 90 - 60 * Math.abs(Math.sin(2 * x))), { low_is_bad: true, limits: { hard: 35, target: 50, usual: 120 } }),
        field("coverage", "layer coverage", "", values((t, p, x) => (p === 0 && x > 0 ? 1 - 0.2 * (t % 5) : NaN))),
        field("nowhere", "exists nowhere", "m", values(() => NaN), { is_log: true }),
        field("constant", "the same everywhere", "m", values(() => 0.25)),
      ],
    },
  };
}

/** A cut normal to y at y0 through rings of cells about the body: layers of prisms, some pyramids and hexahedra, tetrahedra outside. */
function cut_of(name, y0, is_based, origin, blob) {
  const corners = [], first = [0], kind = [], height = [];
  const center = [0, y0, 0];
  const base = is_based ? center : origin;
  const at = (radius, j) => {
    const b = (2 * Math.PI * j) / 48;
    return [radius * 3 * Math.cos(b) - base[0], y0 - base[1], radius * Math.sin(b) - base[2]];
  };
  const add = (polygon, k, h) => {
    for (const point of polygon) corners.push(...point);
    first.push(corners.length / 3);
    kind.push(k);
    height.push(h);
  };
  let radius = 0.5;
  for (let layer = 0; layer < 10; ++layer) {
    const next = radius + 1e-3 * 1.6 ** layer;
    for (let j = 0; j < 48; ++j) add([at(radius, j), at(next, j), at(next, j + 1), at(radius, j + 1)], layer === 9 && j % 6 === 0 ? 1 : layer === 8 && j % 6 === 0 ? 3 : 2, next - radius);
    radius = next;
  }
  for (let j = 0; j < 48; ++j) {
    add([at(radius, j), at(radius * 1.3, j + 0.5), at(radius, j + 1)], 0, NaN);
    add([at(radius, j + 1), at(radius * 1.3, j + 0.5), at(radius * 1.3, j + 1.5)], 0, 0.3 * radius);
  }
  return {
    name,
    origin: [0, y0, 0],
    normal: [0, -1, 0],
    focus: { center, radius: is_based ? 0.4 : 2 },
    ...(is_based ? { base } : {}),
    points: blob.add(new Float32Array(corners)),
    first: blob.add(new Uint32Array(first)),
    kind: blob.add(new Uint8Array(kind)),
    fields: [{ name: "height", title: "height", unit: "m", values: blob.add(new Float32Array(height)), min: 1e-3, max: 0.2, is_log: true, low_is_bad: false, limits: { hard: 0.1, target: null, usual: null } }],
  };
}

const k_limits = { hard: 5, target: 20, usual: 35, usual_share: 0.99 };

function gates() {
  const verdict = (gate, title, state, violations) => ({ gate, measure: null, title, state, violations });
  const quality = (gate, measure, title, state, more) => ({ gate, measure, title, unit: "", bound: "upper", state, reason: null, worst: 12.5, limits: { hard: 100, target: 10, usual: 4 }, share_within: 0.9987, beyond_hard: 0, counted: "nodes", total: 12345, ...more });
  return [
    verdict("G1", "every face matched", "pass", 0),
    verdict("G3", "every cell valid", "fail", 3),
    verdict("G20", "patches", "not checked", 0),
    quality("G5", "orthogonality", "SU2 orthogonality", "warn", { unit: "deg", bound: "lower", worst: 7.2, limits: k_limits }),
    quality("G6", "sub_volume_ratio", "SU2 <i>sub-volume</i> ratio", "fail", { worst: 5.6e8, beyond_hard: 366 }),
    quality("G8", "stack_growth", "growth of a stack", "not checked", { reason: "the mesh has no columns of layers", worst: null, limits: null, share_within: null, beyond_hard: null, total: null }),
    quality("G7", "face_area_ratio", "face area ratio", "pass", { limits: { hard: null, target: null, usual: null } }),
  ];
}

function histograms() {
  const edges = Array.from({ length: 41 }, (_, k) => 2.25 * k);
  const wide = Array.from({ length: 31 }, (_, k) => 10 ** (k / 4));
  const damaged = { measure: "damaged", gate: "G9", title: "damaged", unit: "", is_log: false, low_is_bad: false, edges: [0, 1, 1], counts: [1, 2], limits: k_no_limits, counted: "cells" };
  return [
    { measure: "orthogonality", gate: "G5", title: "SU2 orthogonality", unit: "deg", is_log: false, low_is_bad: true, edges, counts: edges.slice(1).map((e) => Math.round(40 * Math.exp(e / 12))), limits: k_limits, counted: "nodes" },
    { measure: "sub_volume_ratio", gate: "G6", title: "SU2 sub-volume ratio", unit: "", is_log: true, low_is_bad: false, edges: wide, counts: wide.slice(1).map((_, k) => Math.round(3e5 * Math.exp(-((k - 4) ** 2) / 30))), limits: { hard: 1e5, target: 1e3, usual: 200 }, counted: "nodes" },
    damaged,
  ];
}

function places(length) {
  const place = (gate, measure, title, state, value, unit, limit, at, what, rank) => ({ gate, measure, title, state, value, unit, limit, at, what, rank });
  const list = [place("G3", "inverted_cell", "inverted cell", "invalid", null, "", null, [0.3, 0, 0.51], "prism 7 (column 3, layer 0) <img src=x onerror=alert(1)>", 1)];
  for (let k = 0; k < 6; ++k) list.push(place("G5", "orthogonality", "SU2 orthogonality", "warn", 7 + k, "deg", 20, [-length * 0.3 + 0.4 * k, 0.1, 0.47], `node ${k} (line 3, layer 4)`, k + 1));
  for (let k = 0; k < 4; ++k) list.push(place("G6", "sub_volume_ratio", "SU2 <i>sub-volume</i> ratio", "fail", 5.6e8 / (k + 1), "", 1e5, [0.2, 1.2 + 0.3 * k, 0.02], k_nasty, k + 1));
  list.push(place("G15", "tet_growth", "growth of tets", "fail", 44, "", 20, [30, 20, -25], "far away from everything", 1));
  return list;
}

/** A report with everything. `with_cuts` and `kind` make the smaller ones. */
export function make_report({ with_cuts = true, kind = "volume", n = 24 } = {}) {
  const blob = new Blob();
  const origin = [0.25, 0, 0];
  const parts = [ellipsoid([0, 0, 0], [3, 0.5, 0.5], 2 * n, n), ellipsoid([0.2, 0, 0], [0.5, 3, 0.06], n, 2 * n), ellipsoid([0, 0, 0], [60, 60, 60], 12, 16), { points: [], triangles: [], edges: [] }];
  const { surface, counts } = surface_of(parts, origin, blob);
  const names = [["fuselage", "wall"], [k_nasty, "wall"], ["farfield", "farfield"], ["empty patch", "symmetry"]];
  const cuts = with_cuts ? [cut_of("symmetry plane", 0.001, false, origin, blob), cut_of(`cut of ${k_nasty}`, 0.2, true, origin, blob), { ...cut_of("nothing there", 0.3, true, origin, blob), ...empty_cut(blob) }] : [];
  const report = {
    schema: "sterna-report-1",
    program: "sterna 0.1.0",
    title: `case </script> ${k_nasty}.su2`,
    kind,
    facts: [["nodes", "248\u2009181"], ["prisms", "383\u2009760"], ["tetrahedra", "102\u2009400"], ["length", "6 m"]],
    verdict: "INVALID",
    quality_verdict: "FAIL",
    length: 6,
    origin,
    patches: names.map(([name, patch_kind], p) => ({ name, kind: patch_kind, area: 1.25 * (p + 1), triangles: counts[p] })),
    surface,
    cuts,
    places: places(6),
    gates: gates(),
    histograms: histograms(),
    coverage: [
      { patch: "fuselage", area: 9.5, full: 0.93, reduced: 0.05, compressed: 0.015, collapsed: 0.005, lost: [["layers collide", 0.05], ["none", 0.02]] },
      { patch: k_nasty, area: 4.2, full: 1, reduced: 0, compressed: 0, collapsed: 0, lost: [] },
    ],
    run: { stages: [{ name: "volume_mesh", seconds: 8, depth: 0 }, { name: "volume_mesh/envelope", seconds: 5, depth: 1 }, { name: "check", seconds: 2, depth: 0 }], seconds: 10.5, peak_memory: 1.2e9, threads: 2 },
    manifest: { schema: "sterna-manifest-1", program: "sterna 0.1.0", seed: 1, inputs: [{ file: k_nasty, xxh3_128: "89a4d16121722085ac3105f20d9d02eb" }], changes: [`repaired: holes filled: 2 places (7 facets), the largest 0.5 m at (0.25, -1e-06, 0); what is left moved by at most 0 m ${k_nasty}`, k_nasty], options: { envelope: { layers: 30, first_height: 1e-5 }, farfield: { farfield_sides: "" } }, improvement: { remaining: Array.from({ length: 80 }, (_, k) => ({ at: [k, 0, 0], what: `angle ${k}` })) } },
    options_set: { envelope: ["layers"] },
  };
  return { report, blob };
}

function empty_cut(blob) {
  return { points: blob.add(new Float32Array(0)), first: blob.add(new Uint32Array([0])), kind: blob.add(new Uint8Array(0)), fields: [] };
}

/** The least that the contract allows: a surface mesh read from a file. */
export function make_bare_report() {
  const { report, blob } = make_report({ with_cuts: false, kind: "surface", n: 8 });
  Object.assign(report, { verdict: "not checked", quality_verdict: "not checked", facts: [], places: [], gates: [], histograms: [], coverage: [], run: null, manifest: null });
  report.surface.fields = [];
  return { report, blob };
}

const k_pixel = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPj/HwADBwIAMCbHYQAAAABJRU5ErkJggg==";

export function make_series() {
  const cases = [];
  for (const beta of [0, 5])
    for (let alpha = -4; alpha <= 8; alpha += 4) {
      const k = cases.length;
      const state = k === 2 ? "failed" : k === 7 ? "not run" : "done";
      const is_done = state === "done";
      cases.push({
        name: `000${k}_alpha=${alpha} <${k_nasty}>`.slice(0, k === 1 ? 99 : 13),
        folder: `polar/000${k}`,
        state,
        verdict: is_done ? (k === 5 ? "INVALID" : "VALID") : null,
        quality: is_done ? (k % 3 === 2 ? "FAIL: G6 G7; warn: G5" : k % 2 ? "warn: G5" : "pass") : null,  // as statuses of cases say it
        parameters: { alpha, beta, variant: k % 3 === 0 ? "clean, low" : { flap: 20 } },
        figures: is_done ? { cells: 1e5 + 2500 * alpha + 900 * beta, coverage: 0.95 - 0.01 * Math.abs(alpha), ratio: 10 ** (1 + k / 2) } : {},
        gates: is_done ? { G5: k % 2 ? "warn" : "pass", G16: "fail" } : {},
        reused: k > 0 && is_done ? ["surface", "envelope"] : [],
        error: state === "failed" ? "boolean_failed: <b>faces</b> 3 and 7 meet along a line" : null,
        report: is_done ? `polar/000${k}/report.html` : null,
        picture: is_done ? k_pixel : null,
      });
    }
  const figures = [
    { name: "cells", title: "cells", unit: "", is_log: false },
    { name: "coverage", title: "coverage", unit: "", is_log: false },
    { name: "ratio", title: "worst ratio", unit: "m", is_log: true },
  ];
  return { schema: "sterna-series-1", program: "sterna 0.1.0", title: `polar of ${k_nasty}`, parameters: ["alpha", "beta", "variant"], figures, cases };
}
