// Colour maps by control points, colours of patches, and the scale from values to tones.

/** Lightness increases uniformly along each map. The first map is viridis (Smith, van der Walt; CC0). */
export const k_maps = {
  viridis: ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"],
  magma: ["#000004", "#180f3d", "#440f76", "#721f81", "#9e2f7f", "#cd4071", "#f1605d", "#fd9668", "#feca8d", "#fcfdbf"],
  cividis: ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"],
};

export const k_tones = 1024; // number of tones of a field: 0 .. 1022 along the map
export const k_nan_tone = 1023;
export const k_nan_colour = [150, 152, 156];

/** Kinds of cells in a cut, by number. */
export const k_kinds = [
  { name: "tetrahedra", one: "tetrahedron", colour: "#7fa8d9" },
  { name: "pyramids", one: "pyramid", colour: "#e2a04a" },
  { name: "prisms", one: "prism", colour: "#86bf91" },
  { name: "hexahedra", one: "hexahedron", colour: "#b08cc4" },
];

/** States of a value relative to the limits of its field. */
export const k_states = [
  { name: "within all limits", colour: "#4c9f70" },
  { name: "beyond usual", colour: "#d9c24a" },
  { name: "beyond target", colour: "#e08b3a" },
  { name: "beyond hard limit", colour: "#c8372d" },
];

export function rgb_of(hex) {
  return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
}

/** Returns the colour at t in [0, 1] of a map, as [r, g, b] of 0 .. 255. */
export function map_colour(name, t) {
  const points = k_maps[name];
  const x = Math.min(Math.max(t, 0), 1) * (points.length - 1);
  const k = Math.min(Math.floor(x), points.length - 2);
  const a = rgb_of(points[k]), b = rgb_of(points[k + 1]);
  return a.map((v, c) => Math.round(v + (x - k) * (b[c] - v)));
}

function hsl(hue, saturation, lightness) {
  const f = (n) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (lightness - saturation * Math.min(lightness, 1 - lightness) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [f(0), f(8), f(4)];
}

const k_patch_colours = ["#8fa9c4", "#d8a56c", "#8dbb98", "#c98f8f", "#a99cc8", "#cfc07a", "#7fb8bd", "#b7906f", "#9aa86a", "#c59ab8"];
const k_golden_angle = 137.508; // degrees: consecutive colours of the list have very different hues

export function patch_colour(k) {
  return k < k_patch_colours.length ? rgb_of(k_patch_colours[k]) : hsl((k * k_golden_angle) % 360, 0.34, 0.62 - 0.07 * (k % 3));
}

export function css_rgb(rgb) {
  return `rgb(${rgb.join(" ")})`;
}

/** Returns the RGBA bytes of the tones of a field. */
export function field_palette(map_name) {
  const bytes = new Uint8Array(k_tones * 4);
  for (let k = 0; k < k_tones; ++k) bytes.set([...(k === k_nan_tone ? k_nan_colour : map_colour(map_name, k / (k_nan_tone - 1))), 255], 4 * k);
  return bytes;
}

/** Returns the RGBA bytes of a list of colours; the last entry is the colour of NaN. */
export function list_palette(colours) {
  const bytes = new Uint8Array((colours.length + 1) * 4);
  colours.forEach((colour, k) => bytes.set([...colour, 255], 4 * k));
  bytes.set([...k_nan_colour, 255], 4 * colours.length);
  return bytes;
}

/** Returns the smallest and largest finite value; of a logarithmic field, of the positive values. Returns null if there is none. */
export function range_of(values, is_log) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (!(value > (is_log ? 0 : -Infinity)) || value === Infinity) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : null;
}

/** The scale of a field: its range, and the position t in [0, 1] of a value. A logarithmic scale requires a positive range; otherwise the scale is linear. */
export class Scale {
  constructor(low, high, is_log) {
    this.is_log = Boolean(is_log) && low > 0 && high > 0;
    this.low = low;
    this.high = high > low ? high : low + (this.is_log ? low : Math.abs(low) || 1) * 1e-6; // for a single value, because a range of zero width would cause a division by zero
    this.from = this.is_log ? Math.log10(this.low) : this.low;
    this.width = (this.is_log ? Math.log10(this.high) : this.high) - this.from;
  }

  t(value) {
    return ((this.is_log ? Math.log10(Math.max(value, Number.MIN_VALUE)) : value) - this.from) / this.width;
  }

  value(t) {
    const x = this.from + t * this.width;
    return this.is_log ? 10 ** x : x;
  }

  /** Returns round tick values within the range. */
  ticks(n_wanted = 6) {
    if (this.is_log && this.width > 1) {
      const step = Math.max(1, Math.ceil(this.width / n_wanted));
      const list = [];
      for (let e = Math.ceil(this.from - 1e-9); e <= this.from + this.width + 1e-9; e += step) list.push(10 ** e);
      if (list.length >= 2) return list;
    }
    const span = this.high - this.low;
    const rough = span / n_wanted;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
    const list = [];
    for (let k = Math.ceil(this.low / step - 1e-9); k * step <= this.high + span * 1e-9; ++k) list.push(Number((k * step).toPrecision(12)));
    return list;
  }
}

/** Returns the tones of values on a scale. */
export function tones_of(values, scale) {
  const tones = new Uint16Array(values.length);
  const last = k_nan_tone - 1;
  for (let k = 0; k < values.length; ++k) {
    const value = values[k];
    tones[k] = value !== value ? k_nan_tone : Math.round(Math.min(Math.max(scale.t(value), 0), 1) * last);
  }
  return tones;
}

/** Returns the state of a value, 0 .. 3 as in k_states. low_is_bad: values should be above the limits. */
export function state_of(value, limits, low_is_bad) {
  const beyond = (limit) => typeof limit === "number" && (low_is_bad ? value < limit : value > limit);
  return beyond(limits.hard) ? 3 : beyond(limits.target) ? 2 : beyond(limits.usual) ? 1 : 0;
}

export function has_limits(limits) {
  return ["hard", "target", "usual"].some((name) => typeof limits?.[name] === "number");
}

/** Returns the tones of the values of a field (indices into k_states, k_states.length for NaN). */
export function state_tones(field) {
  const tones = new Uint16Array(field.values.length);
  for (let k = 0; k < tones.length; ++k) tones[k] = Number.isNaN(field.values[k]) ? k_states.length : state_of(field.values[k], field.limits, field.low_is_bad);
  return tones;
}
