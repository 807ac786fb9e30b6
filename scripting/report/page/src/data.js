// The report data in the page: JSON, and one gzipped block of arrays to which the JSON refers. See docs/report.md.
import { ReportError } from "./errors.js";

const k_types = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };

function text_of(id) {
  const element = document.getElementById(id);
  if (!element) throw new ReportError(`The report is damaged: the element "${id}" is missing.`);
  return element.textContent.trim();
}

/** Returns the JSON of the page. \throws ReportError */
export function read_json() {
  const text = text_of("sterna-json");
  // The bundle must not contain the marker itself.
  if (text === "" || text.startsWith("<" + "!--STERNA")) throw new ReportError("This file is the empty template of a report without a mesh. The verb report{} of sterna writes reports.");
  let json;
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new ReportError(`The report is damaged: its JSON cannot be read (${error.message}). Write it again.`);
  }
  if (json === null || typeof json !== "object") throw new ReportError("The report is damaged: its JSON is not an object.");
  return json;
}

function bytes_of_base64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; ++k) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/** Returns the unpacked block; empty if the page has none. The text of the element is released. \throws ReportError */
export async function read_blob() {
  const text = text_of("sterna-blob");
  document.getElementById("sterna-blob").textContent = "";
  if (text === "" || text.startsWith("<" + "!--STERNA")) return new ArrayBuffer(0);
  if (typeof DecompressionStream === "undefined") throw new ReportError("This browser is too old to unpack the report's arrays (no DecompressionStream): use Firefox 113, Chrome 80, Safari 16.4 or later.");
  try {
    const stream = new Blob([bytes_of_base64(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
    return await new Response(stream).arrayBuffer();
  } catch { // browsers report "Failed to fetch", which is misleading
    throw new ReportError("The report is damaged: its arrays cannot be unpacked. Was the file cut off? Write it again.");
  }
}

/** Reads and checks arrays of the block. `what` names the array in messages. */
export class Arrays {
  constructor(buffer) {
    this.buffer = buffer;
  }

  read(place, what, { type, n } = {}) {
    const wrong = (why) => new ReportError(`The report is damaged: ${what} ${why}.`);
    const Type = k_types[place?.type];
    if (!Type || !Number.isSafeInteger(place.at) || !Number.isSafeInteger(place.n) || place.at < 0 || place.n < 0) throw wrong("is not an array of the report");
    if (type && place.type !== type) throw wrong(`has type ${place.type} instead of ${type}`);
    if (n !== undefined && place.n !== n) throw wrong(`has ${place.n} entries instead of ${n}`);
    const end = place.at + place.n * Type.BYTES_PER_ELEMENT;
    if (place.at % 4 !== 0) throw wrong(`starts at byte ${place.at}, not at a multiple of 4`);
    if (end > this.buffer.byteLength) throw wrong(`ends at byte ${end}, but there are ${this.buffer.byteLength}`);
    return new Type(this.buffer, place.at, place.n);
  }
}

function fields_of(list, n, arrays, what) {
  return (list ?? []).map((field) => ({
    ...field,
    title: field.title ?? field.name,
    unit: field.unit ?? "",
    limits: field.limits ?? {},
    values: arrays.read(field.values, `field "${field.name}" of ${what}`, { type: "f32", n }),
  }));
}

/** Returns the surface with its arrays; indices are checked. \throws ReportError */
export function read_surface(report, arrays) {
  const surface = report.surface;
  const triangles = arrays.read(surface.triangles, "the list of triangles", { type: "u32" });
  const n = triangles.length / 3;
  if (!Number.isInteger(n)) throw new ReportError(`The report is damaged: ${triangles.length} corners are not a whole number of triangles.`);
  const points = arrays.read(surface.points, "the list of points", { type: "f32" });
  const patch = arrays.read(surface.patch, "the patches of the triangles", { type: "u16", n });
  const edges = arrays.read(surface.edges, "the edges of the triangles", { type: "u8", n });
  const n_points = points.length / 3;
  for (const corner of triangles) if (corner >= n_points) throw new ReportError(`The report is damaged: a triangle has corner ${corner}, but there are ${n_points} points.`);
  for (const p of patch) if (p >= report.patches.length) throw new ReportError(`The report is damaged: a triangle belongs to patch ${p}, but the number of patches is ${report.patches.length}.`);
  return { ...surface, n, points, triangles, patch, edges, fields: fields_of(surface.fields, n, arrays, "the surface") };
}

/** Returns a cut with its arrays, which are checked. \throws ReportError */
export function read_cut(cut, arrays) {
  const what = `the cut "${cut.name}"`;
  const points = arrays.read(cut.points, `points of ${what}`, { type: "f32" });
  const first = arrays.read(cut.first, `polygons of ${what}`, { type: "u32" });
  const n = Math.max(first.length - 1, 0);
  const kind = arrays.read(cut.kind, `kinds of cells of ${what}`, { type: "u8", n });
  for (let k = 0; k < n; ++k) if (first[k + 1] < first[k]) throw new ReportError(`The report is damaged: polygon ${k} of ${what} ends before it begins.`);
  if (n > 0 && first[n] * 3 > points.length) throw new ReportError(`The report is damaged: the polygons of ${what} have ${first[n]} corners, but there are ${points.length / 3} points.`);
  return { ...cut, n, points, first, kind, base: cut.base ?? null, fields: fields_of(cut.fields, n, arrays, what) };
}

/** \throws ReportError if a required table is missing. */
export function require_tables(report, names) {
  for (const name of names) if (!Array.isArray(report[name])) throw new ReportError(`The report is damaged: its table "${name}" is missing.`);
}
