// The colours of the surface and of the cut, and their legends.
import { k_kinds, k_nan_tone, k_states, css_rgb, field_palette, list_palette, patch_colour, range_of, rgb_of, Scale, state_tones, tones_of } from "./colours.js";
import { colour_bar, colour_list } from "./colour_bar.js";
import { count_text } from "./dom.js";

/** Returns the range of a field: the range of the report if it can be drawn, else that of the values; null if there are no values. */
export function field_range(field) {
  const is_usable = Number.isFinite(field.min) && Number.isFinite(field.max) && field.min <= field.max && (!field.is_log || field.min > 0);
  return is_usable ? [field.min, field.max] : range_of(field.values, field.is_log);
}

/** Returns the values of a surface field in the visible patches that can be drawn. */
export function shown_values(field, patch, shown) {
  const values = new Float32Array(field.values.length);
  let n = 0;
  for (let t = 0; t < values.length; ++t) {
    const value = field.values[t];
    if (shown.has(patch[t]) && Number.isFinite(value) && (!field.is_log || value > 0)) values[n++] = value;
  }
  return values.subarray(0, n);
}

const k_most = 0.01; // share of the values that is excluded at each end

/** Returns the range without outliers at both ends; null if there are no values. */
export function range_of_most(values) {
  if (!values.length) return null;
  const sorted = values.slice().sort();
  const at = (share) => sorted[Math.round(share * (sorted.length - 1))];
  return at(k_most) < at(1 - k_most) ? [at(k_most), at(1 - k_most)] : null;
}

/** Returns the painting by a field: {tones, palette, legend, scale}. `by_limits`: the four states instead of the colour map; range null: the range of the field. */
export function paint_field(field, { range, map, by_limits }) {
  if (by_limits) {
    const tones = state_tones(field);
    const counts = new Array(k_states.length + 1).fill(0);
    for (const tone of tones) ++counts[tone];
    const list = k_states.map((state, k) => ({ name: state.name, colour: state.colour, text: count_text(counts[k]) }));
    return { tones, palette: list_palette(k_states.map((s) => rgb_of(s.colour))), legend: colour_list(`${field.title}, by its limits`, list), scale: null };
  }
  const used = range ?? field_range(field) ?? [0, 1];
  const scale = new Scale(used[0], used[1], field.is_log);
  const tones = tones_of(field.values, scale);
  return { tones, palette: field_palette(map), legend: colour_bar(field, scale, map, tones.includes(k_nan_tone)), scale };
}

export function paint_patches(surface, patches) {
  return { tones: surface.patch, palette: list_palette(patches.map((_, k) => patch_colour(k))), legend: null, scale: null };
}

const k_most_named = 10; // number of patches in the legend: more would cover the picture

/** Returns the names of the visible patches; null if there are too many. */
export function patches_legend(patches, shown) {
  const list = patches.map((patch, k) => ({ name: patch.name, colour: patch_css(k) })).filter((_, k) => shown.has(k) && patches[k].triangles > 0);
  return list.length && list.length <= k_most_named ? colour_list("Patches", list) : null;
}

export function paint_kinds(cut) {
  const counts = new Array(k_kinds.length + 1).fill(0);
  const tones = new Uint16Array(cut.n);
  for (let k = 0; k < cut.n; ++k) ++counts[(tones[k] = Math.min(cut.kind[k], k_kinds.length))];
  const list = k_kinds.map((kind, k) => ({ name: kind.name, colour: kind.colour, text: count_text(counts[k]) })).filter((_, k) => counts[k] > 0);
  return { tones, palette: list_palette(k_kinds.map((kind) => rgb_of(kind.colour))), legend: colour_list(`cut \u201c${cut.name}\u201d: cells`, list), scale: null };
}

export function patch_css(k) {
  return css_rgb(patch_colour(k));
}
