// Colours of the surface, its edges, and the list of patches.
import { patch_css } from "./painting.js";
import { has_limits, k_maps } from "./colours.js";
import { button, count_text, fill, h, number_text } from "./dom.js";

export function select_of(label, id, entries, value, onchange) {
  const select = h("select", { id, onchange: () => onchange(select.value) }, entries.map(([name, title]) => h("option", { value: name, selected: name === value }, title)));
  return h("label.field", { for: id }, h("span", null, label), select);
}

export function check_of(label, id, is_on, onchange) {
  const box = h("input", { type: "checkbox", id, checked: is_on, onchange: () => onchange(box.checked) });
  return h("label.check", { for: id }, box, h("span", null, label));
}

function range_fields(app) {
  const { state } = app;
  const low = h("input", { type: "number", step: "any", id: "range_low", "aria-label": "lowest value of the colour bar" });
  const high = h("input", { type: "number", step: "any", id: "range_high", "aria-label": "highest value of the colour bar" });
  const wrong = h("span.wrong", { role: "alert" });
  const apply = () => {
    const range = [low.valueAsNumber, high.valueAsNumber];
    const field = app.field(state.get("color"));
    const why = !range.every(Number.isFinite) ? "two numbers are required" : range[0] >= range[1] ? "the first number must be lower than the second" : field?.is_log && range[0] <= 0 ? "a logarithmic colour bar must start above 0" : "";
    wrong.textContent = why;
    if (!why) state.set({ range });
  };
  const most = () => state.set({ range: app.range_of_most(app.field(state.get("color"))) });
  low.addEventListener("change", apply);
  high.addEventListener("change", apply);
  const row = h("div.range", null, h("span", null, "Range"), low, h("span", null, "to"), high, button("Whole", () => state.set({ range: null }), { title: "From the smallest to the largest value shown", id: "range_whole", kind: ".small" }), button("Most", most, { title: "Without 1 % of the values at each end", id: "range_most", kind: ".small" }), wrong);
  const refresh = () => {
    const field = app.field(state.get("color"));
    row.hidden = !field || state.get("by_limits");
    if (!field) return;
    const range = state.get("range") ?? app.shown_range(field);
    wrong.textContent = range ? "" : "this field has no values here";
    if (range) [low.value, high.value] = range.map((x) => Number(x.toPrecision(5)));
  };
  state.on(["color", "range", "by_limits", "patches"], refresh);
  refresh();
  return row;
}

function patches_list(app) {
  const { report, state } = app;
  const boxes = new Map();
  const toggle = (k, is_shown) => {
    const next = new Set(state.get("patches"));
    if (is_shown) next.add(k);
    else next.delete(k);
    state.set({ patches: next });
  };
  const rows = report.patches.map((patch, k) => {
    const box = h("input", { type: "checkbox", id: `patch_${k}`, onchange: () => toggle(k, box.checked) });
    boxes.set(k, box);
    return h(
      "tr",
      null,
      h("td", null, h("label.check", { for: `patch_${k}` }, box, h("i.swatch", { style: { background: patch_css(k) } }), h("span.patch_name", null, patch.name))),
      h("td", null, patch.kind),
      h("td.number", null, number_text(patch.area)),
      h("td.number", null, count_text(patch.triangles)),
      h("td", null, button("only", () => state.set({ patches: new Set([k]) }), { title: `Show only ${patch.name}`, kind: ".small" })),
    );
  });
  const refresh = ({ patches }) => boxes.forEach((box, k) => (box.checked = patches.has(k)));
  state.on(["patches"], refresh);
  refresh(state.values);
  const choose = (test) => state.set({ patches: new Set(report.patches.map((_, k) => k).filter((k) => test(report.patches[k]))) });
  return [
    h("h2", null, "Patches ", h("span.h2_buttons", null, button("all", () => choose(() => true), { kind: ".small", id: "patches_all" }), button("walls", () => choose((p) => p.kind === "wall"), { kind: ".small", id: "patches_walls" }), button("none", () => choose(() => false), { kind: ".small", id: "patches_none" }))),
    h("table.list", null, h("thead", null, h("tr", null, ["patch", "kind"].map((t) => h("th", { scope: "col" }, t)), h("th.number", { scope: "col" }, "area m\u00b2"), h("th.number", { scope: "col" }, "triangles"), h("th"))), h("tbody", null, rows)),
  ];
}

export function surface_tab(app) {
  const { state, report } = app;
  const fields = report.surface?.fields ?? [];
  const by_limits = check_of("by its limits, in four colours", "by_limits", state.get("by_limits"), (is_on) => state.set({ by_limits: is_on }));
  const map = select_of("Colour map", "map", Object.keys(k_maps).map((name) => [name, name]), state.get("map"), (name) => state.set({ map: name }));
  const about = h("p.note");
  const refresh = () => {
    const field = fields.find((entry) => entry.name === state.get("color"));
    by_limits.hidden = !has_limits(field?.limits);
    map.hidden = !field;
    fill(about, field ? (field.low_is_bad ? "Low values are bad." : "High values are bad, where limits are given.") : "One colour for each patch.");
    about.hidden = Boolean(field) && !has_limits(field.limits);
  };
  state.on(["color"], refresh);
  refresh();
  const edges = check_of("edges of the mesh", "edges_box", state.get("edges"), (is_on) => state.set({ edges: is_on }));
  const markers = check_of("all worst locations as markers", "markers_box", state.get("markers"), (is_on) => state.set({ markers: is_on }));
  state.on(["edges", "markers"], (values) => {
    edges.firstChild.checked = values.edges;
    markers.firstChild.checked = values.markers;
  });
  const surface = report.surface;
  const color = select_of("Colour", "color", [["patch", "by patch"], ...fields.map((field) => [field.name, field.unit ? `${field.title} [${field.unit}]` : field.title])], state.get("color"), (name) => state.set({ color: name, range: null }));
  state.on(["color"], (values) => (color.lastChild.value = values.color));
  return [
    h("h2", null, "Colour"),
    h("div.form", null, color, map, range_fields(app), by_limits, about, edges, report.places.length ? markers : null),
    surface.shown < surface.total ? h("p.note.thinned", null, `Thinned: the picture holds ${count_text(surface.shown)} of ${count_text(surface.total)} triangles. Tables, locations and histograms describe the whole mesh.`) : null,
    patches_list(app),
  ];
}
