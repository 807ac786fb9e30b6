// Selected cases side by side: pictures, parameters, quantities and gates; differences are marked.
import { chip } from "./banner.js";
import { fill, h, number_text } from "./dom.js";
import { select_of } from "./surface_tab.js";

const k_same = 1e-9; // relative difference of values that are the same number

function differs(values) {
  const [first, ...rest] = values;
  return rest.some((value) => (typeof value === "number" && typeof first === "number" ? Math.abs(value - first) > k_same * Math.max(Math.abs(value), Math.abs(first)) : (value ?? null) !== (first ?? null)));
}

function relative_text(value, first) {
  if (typeof value !== "number" || typeof first !== "number" || first === 0 || value === first) return null;
  const change = (value - first) / Math.abs(first);
  return h("small.change", null, ` ${change > 0 ? "+" : "\u2212"}${number_text(Math.abs(100 * change), 3)} %`);
}

function picture_of(entry) {
  if (/^data:image\/(png|jpeg|webp);base64,/.test(entry.picture ?? "")) return h("img", { src: entry.picture, alt: `Picture of ${entry.name}`, loading: "lazy" });
  return h("div.no_picture", null, entry.error ?? (entry.state === "done" ? "no picture" : entry.state));
}

export function compare_section(app) {
  const { state, series } = app;
  const by_name = new Map(series.cases.map((entry) => [entry.name, entry]));
  const body = h("div.compare_body");
  const add = h("div.form.inline");
  const refresh = () => {
    const chosen = state.get("compare").map((name) => by_name.get(name)).filter(Boolean);
    const others = series.cases.filter((entry) => !chosen.includes(entry));
    fill(add, others.length ? select_of("add", "compare_add", [["", "case \u2026"], ...others.map((entry) => [entry.name, entry.name])], "", (name) => name && state.set({ compare: [...state.get("compare"), name] })) : null);
    body.style.setProperty("--n_compared", String(Math.max(2, chosen.length)));
    if (!chosen.length) return fill(body, h("p.note", null, "Choose cases in the table to see them side by side."));
    const head = chosen.map((entry) =>
      h("th.compared", { scope: "col" }, picture_of(entry), h("div.compared_name", null, entry.report ? h("a", { href: entry.report }, entry.name) : entry.name, h("button.small", { type: "button", title: `Remove ${entry.name}`, onclick: () => state.set({ compare: state.get("compare").filter((name) => name !== entry.name) }) }, "\u00d7"))),
    );
    const rows = app.columns
      .filter((column) => column.key !== "name")
      .map((column) => {
        const values = chosen.map((entry) => column.of(entry));
        if (values.every((value) => value === undefined || value === null || value === "")) return null;
        const is_different = differs(values);
        const cells = values.map((value, k) => {
          const is_word_of_state = column.kind === "gate" || column.key === "verdict" || column.key === "quality" || (column.key === "state" && value !== "done");
          const text = value === undefined || value === null || value === "" ? "\u2013" : is_word_of_state ? chip(value) : typeof value === "number" ? number_text(value, 6) : String(value);
          return h("td", { class: is_different && k > 0 && differs([values[0], value]) ? "differs" : null }, text, column.kind === "figure" && k > 0 ? relative_text(value, values[0]) : null);
        });
        return h("tr", { class: is_different ? "different" : null }, h("th", { scope: "row" }, column.title, column.unit ? h("small", null, ` [${column.unit}]`) : null), cells);
      });
    fill(body, h("div.scroll", null, h("table.compare", { id: "compare" }, h("thead", null, h("tr", null, h("td"), head)), h("tbody", null, rows))), h("p.note", null, "Differences are relative to the first case."));
  };
  state.on(["compare"], refresh);
  refresh();
  return h("section.comparison", null, h("div.section_head", null, h("h2", null, "Side by side"), add), body);
}
