// The previous run against this run: alternately in the picture, or both from one camera; measures and gates in a table.
import { chip } from "../banner.js";
import { button, fill, h, quantity_text } from "../dom.js";

/** Returns rows {name, before, now} of facts and gates. */
function rows_of(before, now) {
  const rows = [];
  const names = [...new Set([...before.facts, ...now.facts].map(([name]) => name))];
  const fact = (scene, name) => scene.facts.find(([known]) => known === name)?.[1] ?? "\u2013";
  for (const name of names) rows.push({ name, before: fact(before, name), now: fact(now, name) });
  for (const gate of now.gates ?? []) {
    const old = before.gates?.find((known) => known.gate === gate.gate && known.measure === gate.measure);
    const cell = (g) => (g ? [chip(g.state), typeof g.worst === "number" ? ` ${quantity_text(g.worst, g.unit)}` : ""] : "\u2013");
    rows.push({ name: `${gate.gate} ${gate.title}`, before: cell(old), now: cell(gate), is_other: !old || old.worst !== gate.worst || old.state !== gate.state });
  }
  return rows.map((row) => ({ ...row, is_other: row.is_other ?? row.before !== row.now }));
}

export function compare_tab(bench) {
  const { state } = bench;
  const body = h("div", { id: "compare_tab" });
  const flick = button("Show the previous run", () => state.set({ is_before: !state.get("is_before") }), { title: "Switch between the two (key B)", pressed: false, id: "flick" });
  const beside = button("Side by side", () => state.set({ is_split: !state.get("is_split") }), { title: "Show both pictures from the same camera (key S)", pressed: false, id: "side_by_side" });
  const only = h("input", { type: "checkbox", id: "compare_only", onchange: () => refresh() });
  const refresh = () => {
    const shown = bench.chosen();
    flick.setAttribute("aria-pressed", String(state.get("is_before")));
    beside.setAttribute("aria-pressed", String(state.get("is_split")));
    if (!shown?.previous) return fill(body, h("p.note", null, "No previous run has the selected object."));
    const rows = rows_of(shown.previous.scene, shown.scene).filter((row) => !only.checked || row.is_other);
    fill(
      body,
      h("h2", null, shown.key),
      h("div.form", null, h("div.buttons", null, flick, beside), h("label.check", null, only, "only changes")),
      h("table.list", { id: "compare" }, h("thead", null, h("tr", null, ["", "before", "now"].map((t) => h("th", null, t)))), h("tbody", null, rows.map((row) => h(`tr${row.is_other ? ".changed" : ""}`, null, h("td", null, row.name), h("td", null, row.before), h("td", null, row.now))))),
    );
  };
  state.on(["is_split"], refresh);
  state.on(["is_before", "chosen"], () => {
    if (state.get("is_before") && state.get("is_split")) state.set({ is_split: false });
    for (const shown of bench.view.objects.values()) {
      const wanted = state.get("is_before") && shown.key === state.get("chosen") && shown.previous ? shown.previous : { scene: shown.scene, set: shown.set };
      if (shown.drawn && shown.drawn.set !== wanted.set) shown.show(wanted);
    }
    bench.view.style_layers();
    bench.paint();
    refresh();
  });
  state.on(["shown"], () => {
    if (state.get("is_before")) state.set({ is_before: false });
    refresh();
  });
  refresh();
  return body;
}
