// The legend of a colouring: bar with round marks, limits and a patch of grey for values that do not exist; or a list of colours.
import { css_rgb, has_limits, k_nan_colour, map_colour } from "./colours.js";
import { h, number_text } from "./dom.js";

const k_stops = 33;
const k_near_end = 0.06; // of the bar: half of a label
const k_limit_names = { hard: "hard", target: "target", usual: "usual" };

/** Class of a label at t: those near the ends are written inwards. */
function end_class(t) {
  return t < k_near_end ? "at_low" : t > 1 - k_near_end ? "at_high" : null;
}

/** The bar of a field. */
export function colour_bar(field, scale, map_name, has_nan) {
  const stops = Array.from({ length: k_stops }, (_, k) => css_rgb(map_colour(map_name, k / (k_stops - 1))));
  const unit = field.unit ? ` [${field.unit}]` : "";
  const bar = h("div.bar_strip", { style: { background: `linear-gradient(to right, ${stops.join(", ")})` } });
  const ticks = h("div.bar_ticks");
  for (const value of scale.ticks()) ticks.append(h("span", { class: end_class(scale.t(value)), style: { left: `${(100 * scale.t(value)).toFixed(2)}%` } }, number_text(value, 3)));
  const limits = h("div.bar_limits");
  if (has_limits(field.limits))
    for (const name of Object.keys(k_limit_names)) {
      const value = field.limits[name];
      if (typeof value !== "number") continue;
      const t = scale.t(value);
      const is_outside = !(t >= 0 && t <= 1);
      const classes = [`limit_${name}`, is_outside ? "outside" : null, end_class(Math.min(Math.max(t, 0), 1))].filter(Boolean);
      limits.append(h(`span.${classes.join(".")}`, { style: { left: `${(100 * Math.min(Math.max(t, 0), 1)).toFixed(2)}%` }, title: `${name} limit ${number_text(value)} ${field.unit}${is_outside ? ", outside of the bar" : ""}` }, `${t < 0 ? "\u2039 " : ""}${name} ${number_text(value, 3)}${t > 1 ? " \u203a" : ""}`));
    }
  return h(
    "div.legend",
    null,
    h("div.legend_title", null, `${field.title}${unit}`, scale.is_log ? h("small", null, " logarithmic") : null, has_nan ? h("span.nan_key", null, h("i", { style: { background: css_rgb(k_nan_colour) } }), "does not exist here") : null),
    h("div.bar", null, limits, bar, ticks),
  );
}

/** Colours with names and counts: [{name, colour: css, text}]. */
export function colour_list(title, list) {
  return h("div.legend", null, h("div.legend_title", null, title), h("div.legend_list", null, list.map(({ name, colour, text }) => h("span", null, h("i", { style: { background: colour } }), name, text ? h("small", null, ` ${text}`) : null))));
}
