// Requests to the program that serves the page. Addresses are relative, so the secret in front of them is part of every request.
import { Arrays, read_cut, read_surface } from "../data.js";
import { ReportError } from "../errors.js";

/** Returns the text of a refusal, for the user. */
async function refusal(response) {
  try {
    return (await response.json()).text ?? `refused (${response.status})`;
  } catch {
    return `refused (${response.status})`;
  }
}

async function get(name, query, signal) {
  const response = await fetch(`${name}?${new URLSearchParams(query)}`, { signal, cache: "no-store" });
  if (!response.ok) throw new ReportError(await refusal(response));
  return response;
}

export async function post(name, body) {
  const response = await fetch(name, { method: "POST", headers: { "X-Sterna": "1", "Content-Type": "application/json" }, body: JSON.stringify(body), cache: "no-store" });
  if (!response.ok) throw new ReportError(await refusal(response));
  return response;
}

/** Returns the news; waits until there are any. */
export async function get_state(since, lines, signal) {
  return (await get("state", { since, lines }, signal)).json();
}

export async function get_script() {
  return (await (await get("script", {})).json()).text;
}

/** Returns the findings of inspect{} on the surface with this key. */
export async function get_inspection(key) {
  return (await post("inspect", { key })).json();
}

/** Returns the cases of the series of the page. */
export async function get_cases() {
  return (await get("cases", {})).json();
}

/** Returns the address, within the page, of a picture that a case has written. */
export async function get_picture(picture) {
  return URL.createObjectURL(await (await get("picture", { picture })).blob());
}

/** Returns JSON and arrays of a block: {json, arrays}. \throws ReportError */
function read_block(buffer) {
  if (buffer.byteLength < 8) throw new ReportError("The picture is incomplete.");
  const length = new DataView(buffer).getUint32(0, true);
  if (8 + length > buffer.byteLength || length % 4 !== 0) throw new ReportError("The picture is damaged: its JSON is longer than the whole picture.");
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  return { json, arrays: new Arrays(buffer.slice(8 + length)) };
}

/** Returns the scene of an object, with the arrays of its surface. */
export async function get_scene(scene) {
  const { json, arrays } = read_block(await (await get("scene", { scene })).arrayBuffer());
  if (json.schema !== "sterna-scene-1") throw new ReportError(`The picture has the schema ${json.schema}.`);
  return { ...json, surface: read_surface(json, arrays) };
}

/** Returns a cut through the volume mesh with this key. */
export async function get_cut(key, plane) {
  const { json, arrays } = read_block(await (await post("cut", { key, plane })).arrayBuffer());
  return read_cut(json, arrays);
}
