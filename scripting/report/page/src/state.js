// The selections of the user, stored in the address after "#", so that a link restores them.

const k_delay = 250; // ms: browsers limit how often an address may change

/** Values by name with listeners; `set` notifies the listeners of the changed names. */
export class State {
  constructor(values) {
    this.values = values;
    this.listeners = [];
  }

  get(name) {
    return this.values[name];
  }

  set(changes) {
    const changed = Object.keys(changes).filter((name) => this.values[name] !== changes[name]);
    if (!changed.length) return;
    Object.assign(this.values, changes);
    for (const { names, call } of this.listeners) if (names === null || changed.some((name) => names.includes(name))) call(this.values);
  }

  /** Registers a listener for changes of these names (null: of all names). */
  on(names, call) {
    this.listeners.push({ names, call });
  }
}

/** Returns the entries after "#" as an object of strings. */
export function read_hash() {
  const entries = {};
  for (const part of location.hash.replace(/^#/, "").split("&")) {
    const at = part.indexOf("=");
    if (at <= 0) continue;
    try {
      entries[decodeURIComponent(part.slice(0, at))] = decodeURIComponent(part.slice(at + 1));
    } catch {
      // An entry with a damaged escape sequence is ignored.
    }
  }
  return entries;
}

let waiting = 0;

/** Writes the entries after "#" with a delay; null and undefined are omitted. */
export function write_hash(entries_now) {
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    const text = Object.entries(entries_now())
      .filter(([, value]) => value !== null && value !== undefined && value !== "")
      .map(([name, value]) => `${encodeURIComponent(name)}=${encodeURIComponent(value).replaceAll("%2C", ",").replaceAll("%3D", "=")}`)
      .join("&");
    history.replaceState(null, "", text ? `#${text}` : "#");
  }, k_delay);
}
