// Elements and numbers. All texts are text nodes, so that names of patches or files cannot be interpreted as markup.

/** Returns an element: h("button.primary", {onclick, title}, "text", child, ...). Attributes that are false, null or undefined are omitted. */
export function h(kind, attributes, ...children) {
  const [tag, ...classes] = kind.split(".");
  const element = document.createElement(tag || "div");
  if (classes.length) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === false || value === null || value === undefined) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "style") Object.assign(element.style, value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  append(element, children);
  return element;
}

export function append(element, children) {
  for (const child of children.flat(Infinity)) if (child !== null && child !== undefined && child !== false) element.append(child);
}

/** Replaces the content of the element by these children. */
export function fill(element, ...children) {
  element.replaceChildren();
  append(element, children);
  return element;
}

/** Returns a button; `pressed` (true or false) makes it a toggle button. */
export function button(label, onclick, { title, pressed, kind = "", id } = {}) {
  return h(`button${kind}`, { type: "button", onclick, title, id, "aria-pressed": pressed === undefined ? null : String(pressed) }, label);
}

const k_thin_space = "\u2009";

/** Returns a whole number as "12 345". */
export function count_text(n) {
  if (!Number.isFinite(n)) return "\u2013";
  return Math.round(n).toString().replace(/\B(?=(\d{3})+(?!\d))/g, k_thin_space);
}

/** Returns a number with four significant digits, as in messages of sterna; a dash for a missing value. */
export function number_text(x, digits = 4) {
  if (typeof x !== "number" || !Number.isFinite(x)) return "\u2013";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (Number.isInteger(x) && size < 1e9) return x < 0 ? `\u2212${count_text(size)}` : count_text(x);
  const text = size >= 1e6 || size < 1e-3 ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e") : String(Number(x.toPrecision(digits)));
  return text.replace(/^-/, "\u2212");
}

/** Returns the value of a measure with its unit. */
export function quantity_text(x, unit, digits = 4) {
  const text = Number.isFinite(x) && Math.abs(x) >= 1e6 ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e").replace(/^-/, "\u2212") : number_text(x, digits);
  return unit && text !== "\u2013" ? `${text} ${unit}` : text;
}

/** Returns a share as percent; a share below 1 is never displayed as 100 %. */
export function percent_text(share) {
  if (typeof share !== "number" || !Number.isFinite(share)) return "\u2013";
  const text = (100 * share).toFixed(2);
  if (share < 1 && text === "100.00") return "> 99.99 %";
  if (share > 0 && text === "0.00") return "< 0.01 %";
  return `${text} %`;
}

export function position_text(at) {
  return `(${at.map((x) => number_text(x, 6)).join(", ")})`;
}

export function seconds_text(seconds) {
  if (!Number.isFinite(seconds)) return "\u2013";
  if (seconds < 60) return `${seconds < 10 ? seconds.toFixed(2) : seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  const minutes = Math.floor(whole / 60) % 60;
  const rest = `${String(whole % 60).padStart(2, "0")} s`;
  return whole < 3600 ? `${minutes} min ${rest}` : `${Math.floor(whole / 3600)} h ${String(minutes).padStart(2, "0")} min ${rest}`;
}

export function bytes_text(bytes) {
  if (!Number.isFinite(bytes)) return "\u2013";
  const units = ["B", "kB", "MB", "GB", "TB"];
  let k = 0;
  while (bytes >= 1000 && k + 1 < units.length) {
    bytes /= 1000;
    ++k;
  }
  return `${k === 0 ? bytes : Number(bytes.toPrecision(3))} ${units[k]}`;
}

/** Returns the present colour of a CSS variable of the page. */
export function css_colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
