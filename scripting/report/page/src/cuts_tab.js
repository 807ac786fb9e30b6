// Cut planes: selection of a cut, display of the surface around it, and colours of its cells.
import { button, count_text, fill, h, position_text } from "./dom.js";
import { check_of, select_of } from "./surface_tab.js";

const k_around = [["clip", "cut off in front of the plane"], ["show", "whole"], ["hide", "not shown"]];

function direction_text(normal) {
  const axis = normal.findIndex((x) => Math.abs(x) > 0.9999);
  return axis >= 0 ? `normal to ${"xyz"[axis]}` : `normal ${position_text(normal.map((x) => Number(x.toFixed(3))))}`;
}

export function cuts_tab(app) {
  const { report, state } = app;
  const rows = report.cuts.map((cut, k) => {
    const n = Math.max((cut.first?.n ?? 1) - 1, 0);
    return h("button.row", { type: "button", id: `cut_${k}`, onclick: () => state.set({ cut: state.get("cut") === k ? -1 : k }) }, h("b", null, cut.name), h("small", null, `${direction_text(cut.normal)} through ${position_text(cut.origin)} m \u00b7 ${count_text(n)}${cut.total > n ? ` of ${count_text(cut.total)}` : ""} cells`));
  });
  const options = h("div.form");
  const refresh = () => {
    const { cut, cut_color } = state.values;
    rows.forEach((row, k) => row.setAttribute("aria-pressed", String(k === cut)));
    const chosen = report.cuts[cut];
    if (!chosen) return fill(options, h("p.note", null, "Choose a cut: the camera flies to it and looks along its normal."));
    const fields = chosen.fields ?? [];
    const colours = [["kind", "by kind of cell"], ...fields.map((field) => [field.name, field.unit ? `${field.title ?? field.name} [${field.unit}]` : (field.title ?? field.name)])];
    const value = colours.some(([name]) => name === cut_color) ? cut_color : "kind";
    fill(
      options,
      select_of("Colour of the cells", "cut_color", colours, value, (name) => state.set({ cut_color: name })),
      select_of("Surface", "around", k_around, state.get("around"), (name) => state.set({ around: name })),
      check_of("outlines of the cells", "cut_edges", state.get("cut_edges"), (is_on) => state.set({ cut_edges: is_on })),
      h("div.buttons", null, button("Fly there", () => app.view && app.fly_to_cut(cut), { id: "cut_fly", kind: ".small" }), button("No cut", () => state.set({ cut: -1 }), { id: "cut_none", kind: ".small" })),
    );
  };
  state.on(["cut"], refresh);
  refresh();
  return [h("h2", null, "Cuts through the cells"), h("div.rows", null, rows), options];
}
