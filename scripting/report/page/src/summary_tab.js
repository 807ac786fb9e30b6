// Facts and gates: the results and their limits.
import { chip } from "./banner.js";
import { button, count_text, h, number_text, percent_text, quantity_text } from "./dom.js";

function limits_text(gate) {
  const sign = gate.bound === "lower" ? "\u2265" : "\u2264";
  return ["hard", "target", "usual"].filter((name) => typeof gate.limits?.[name] === "number").map((name) => h("span.limit", null, h("small", null, name), ` ${sign} ${number_text(gate.limits[name])}`));
}

/** A position between a good value and the hard limit has no general definition, so the bar shows shares. */
function share_bar(share) {
  return h("span.share", { title: `${percent_text(share)} within` }, h("i", { style: { width: `${(100 * share).toFixed(2)}%` } }));
}

function open_gate(app, gate) {
  const has_places = app.report.places.some((place) => place.gate === gate.gate && (gate.measure ? place.measure === gate.measure : place.state === "invalid"));
  const has_histogram = app.report.histograms.some((histogram) => histogram.measure === gate.measure);
  const buttons = [];
  if (has_places) buttons.push(button("places", (event) => (event.stopPropagation(), app.state.set({ gate: gate.gate, tab: "places", markers: true })), { title: `Worst locations of ${gate.gate}`, kind: ".small" }));
  if (has_histogram)
    buttons.push(button("histogram", (event) => (event.stopPropagation(), app.state.set({ tab: "histograms" }), app.show_histogram?.(gate.measure)), { title: `Histogram: ${gate.title}`, kind: ".small" }));
  return buttons;
}

function verdict_row(app, gate) {
  const places = open_gate(app, gate);
  return h("div.gate", { "data-gate": gate.gate }, h("span.gate_name", null, gate.gate), h("span.gate_title", null, gate.title), chip(gate.state), gate.violations ? h("span.violations", null, `${count_text(gate.violations)} violations`) : null, h("span.gate_buttons", null, places));
}

/** Returns "12 prisms beyond the hard limit, 0.0004 % of the volume, at 3 places, 9 too large, 3 too small; 830 beyond the target"; null if no limit is exceeded. */
function counts_text(gate) {
  const n = (gate.too_small ?? 0) + (gate.too_large ?? 0);
  if (!n) return gate.beyond_hard > 0 ? `${count_text(gate.beyond_hard)} beyond the hard limit` : null;
  const is_hard = gate.beyond_hard > (gate.forced ?? 0), soft = typeof gate.limits?.target === "number" ? "the target" : "the usual limit";
  const parts = [`${count_text(n)} ${gate.counted === "area" ? "lines" : gate.counted} beyond ${is_hard ? "the hard limit" : soft}`];
  if (gate.share_beyond > 0) parts.push(`${percent_text(gate.share_beyond)} of the ${gate.share_of}`);
  if (typeof gate.separate_places === "number") parts.push(`at ${count_text(gate.separate_places)} ${gate.separate_places === 1 ? "location" : "locations"}`);
  if (gate.too_large) parts.push(gate.too_small ? `${count_text(gate.too_large)} too large` : "too large");
  if (gate.too_small) parts.push(gate.too_large ? `${count_text(gate.too_small)} too small` : "too small");
  return parts.join(", ") + (is_hard && gate.beyond_target > gate.beyond_hard ? `; ${count_text(gate.beyond_target)} beyond ${soft}` : "");
}

function quality_row(app, gate) {
  const is_known = gate.state !== "not checked";
  const counts = is_known ? counts_text(gate) : null;
  const beyond = counts ? h("span.beyond", null, counts) : null;
  return h(
    "div.gate.quality",
    { "data-gate": gate.gate, "data-measure": gate.measure },
    h("span.gate_name", null, gate.gate),
    h("span.gate_title", null, gate.title),
    chip(gate.state),
    is_known
      ? h("div.gate_more", null, h("span.worst", null, h("small", null, "worst"), ` ${quantity_text(gate.worst, gate.unit)}`), limits_text(gate), typeof gate.share_within === "number" ? h("span.within", null, share_bar(gate.share_within), percent_text(gate.share_within)) : null)
      : h("div.gate_more", null, h("span.reason", null, gate.reason ?? "not checked")),
    beyond,
    h("span.gate_buttons", null, open_gate(app, gate)),
  );
}

const k_point = /\((-?[\d.]+(?:e[-+]?\d+)?), (-?[\d.]+(?:e[-+]?\d+)?), (-?[\d.]+(?:e[-+]?\d+)?)\)/;

/** Returns one change of the surface, with a link to its location if it names one. */
function change_row(app, text) {
  const found = text.match(k_point);
  const at = found?.slice(1).map(Number);
  return h("li.surface_change", null, text, at ? [" ", button("show", () => app.view && app.fly_to_point(at), { title: `Look at ${found[0]}`, kind: ".small" })] : null);
}

/** Returns a heading and a list for changes of the surface relative to the files: "repaired: holes filled: 3 places ...; cut ...". */
function changes(app) {
  const list = app.report.manifest?.changes ?? [];
  if (!list.length) return null;
  return [
    h("h2", { id: "changes" }, "Changes of the surface"),
    list.map((change) => {
      const colon = change.indexOf(": ");
      const what = colon < 0 ? [] : change.slice(colon + 2).split("; ");
      return h("section.surface_changes", null, h("h3", null, colon < 0 ? change : change.slice(0, colon)), what.length ? h("ul", null, what.map((text) => change_row(app, text))) : null);
    }),
  ];
}

export function summary_tab(app) {
  const { report } = app;
  const verdict = report.gates.filter((gate) => !gate.measure), quality = report.gates.filter((gate) => gate.measure);
  const counts = {};
  for (const gate of quality) counts[gate.state] = (counts[gate.state] ?? 0) + 1;
  return [
    h("h2", null, "Mesh"),
    report.verdict_line ? h("p", { id: "verdict_line" }, report.verdict_line) : null,
    h("table.facts", null, h("tbody", null, (report.facts ?? []).map(([name, value]) => h("tr", null, h("th", { scope: "row" }, name), h("td", null, value))))),
    changes(app),
    verdict.length ? [h("h2", null, "Validity"), h("div.gates", null, verdict.map((gate) => verdict_row(app, gate)))] : null,
    quality.length ? [h("h2", null, "Quality gates ", h("small", null, Object.entries(counts).map(([state, n]) => `${n} ${state}`).join(", "))), h("div.gates", null, quality.map((gate) => quality_row(app, gate)))] : null,
  ];
}
