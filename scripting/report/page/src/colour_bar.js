// The legend of a colouring: a bar with round tick values, limits, and a grey area for missing values; or a list of colours.
import { css_rgb, has_limits, k_nan_colour, map_colour } from "./colours.js";
import { h, number_text } from "./dom.js";

const k_stops = 33;
const k_near_end = 0.06; // relative to the bar: half of a label
const k_limit_names = ["hard", "target", "usual"];
const k_label = 0.2; // relative to the bar: a label with its margins
const k_row = 14; // pixels, height of a row of labels

/** Returns the class of a label at position t. Labels near the ends are aligned inwards. */
function end_class(t) {
  return t < k_near_end ? "at_low" : t > 1 - k_near_end ? "at_high" : null;
}

/** Returns the colour bar of a field. */
export function colour_bar(field, scale, map_name, has_nan) {
  const stops = Array.from({ length: k_stops }, (_, k) => css_rgb(map_colour(map_name, k / (k_stops - 1))));
  const unit = field.unit ? ` [${field.unit}]` : "";
  const bar = h("div.bar_strip", { style: { background: `linear-gradient(to right, ${stops.join(", ")})` } });
  const ticks = h("div.bar_ticks");
  for (const value of scale.ticks()) ticks.append(h("span", { class: end_class(scale.t(value)), style: { left: `${(100 * scale.t(value)).toFixed(2)}%` } }, number_text(value, 3)));
  const limits = h("div.bar_limits");
  const list = has_limits(field.limits) ? k_limit_names.filter((name) => typeof field.limits[name] === "number").map((name) => ({ name, value: field.limits[name], t: scale.t(field.limits[name]) })) : [];
  const row_ends = []; // position on the bar up to which each row of labels is occupied
  for (const { name, value, t } of list.sort((a, b) => a.t - b.t)) {
    const at = Math.min(Math.max(t, 0), 1);
    const is_outside = at !== t;
    const from = at - (end_class(at) === "at_low" ? 0 : end_class(at) === "at_high" ? k_label : k_label / 2);
    const free = row_ends.findIndex((end) => end <= from);
    const row = free >= 0 ? free : row_ends.length;
    row_ends[row] = from + k_label;
    const title = `${name} limit ${number_text(value)} ${field.unit}${is_outside ? ", outside of the bar" : ""}`;
    const classes = [`limit_${name}`, end_class(at)].filter(Boolean).join(".");
    limits.append(h(`span.${classes}`, { title, style: { left: `${(100 * at).toFixed(2)}%`, bottom: `${k_row * row}px` } }, `${t < 0 ? "\u2039 " : ""}${name} ${number_text(value, 3)}${t > 1 ? " \u203a" : ""}`));
    if (!is_outside) bar.append(h(`i.limit_${name}`, { title, style: { left: `${(100 * at).toFixed(2)}%` } }));
  }
  if (list.length) limits.style.height = `${k_row * row_ends.length + 2}px`;
  return h(
    "div.legend",
    null,
    h("div.legend_title", null, `${field.title}${unit}`, scale.is_log ? h("small", null, " logarithmic") : null, has_nan ? h("span.nan_key", null, h("i", { style: { background: css_rgb(k_nan_colour) } }), "does not exist here") : null),
    h("div.bar", null, limits, bar, ticks),
  );
}

/** Returns a list of colours with names and counts: [{name, colour: css, text}]. */
export function colour_list(title, list) {
  return h("div.legend", null, h("div.legend_title", null, title), h("div.legend_list", null, list.map(({ name, colour, text }) => h("span", null, h("i", { style: { background: colour } }), name, text ? h("small", null, ` ${text}`) : null))));
}
