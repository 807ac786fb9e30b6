// Fills the page's template as sterna does: JSON with "<" escaped, arrays as base64 of one gzipped blob.
import { gzipSync } from "node:zlib";

const k_types = new Map([[Float32Array, "f32"], [Uint32Array, "u32"], [Uint16Array, "u16"], [Uint8Array, "u8"]]);

/** Collects arrays into one blob, each at a multiple of 4. */
export class Blob {
  constructor() {
    this.parts = [];
    this.size = 0;
  }

  add(array) {
    const place = { type: k_types.get(array.constructor), at: this.size, n: array.length };
    const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
    this.parts.push(bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4));
    this.size += bytes.length + ((4 - (bytes.length % 4)) % 4);
    return place;
  }

  text() {
    return gzipSync(Buffer.concat(this.parts)).toString("base64");
  }
}

/** The page with `report` (an object, or JSON text as it stands) and the blob's text. */
export function packed_page(template, report, blob_text) {
  const json = (typeof report === "string" ? report : JSON.stringify(report)).replaceAll("<", "\\u003c");
  return template.replace("<!--STERNA_JSON-->", () => json).replace("<!--STERNA_BLOB-->", () => blob_text);
}
