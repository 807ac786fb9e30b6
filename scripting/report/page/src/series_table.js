// The cases as a table: sorted by any column, with a selection of columns and a selection of cases for the comparison.
import { chip } from "./banner.js";
import { button, fill, h, number_text } from "./dom.js";

/** Compares values: numbers by size, words alphabetically, missing values last in both directions. */
function compared(a, b, is_down) {
  const is_missing = (x) => x === null || x === undefined || x === "";
  if (is_missing(a) || is_missing(b)) return Number(is_missing(a)) - Number(is_missing(b));
  const order = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true });
  return is_down ? -order : order;
}

export function sorted_cases(app) {
  const { sort, down } = app.state.values;
  const column = app.columns.find((entry) => entry.key === sort);
  const list = app.series.cases.map((entry, k) => ({ entry, k }));
  if (column) list.sort((a, b) => compared(column.of(a.entry), column.of(b.entry), down) || a.k - b.k);
  return list.map(({ entry }) => entry);
}

function cell_of(column, entry) {
  const value = column.of(entry);
  if (column.key === "name") {
    const name = entry.report ? h("a", { href: entry.report }, entry.name) : entry.name;
    return h("td.case_name", { title: entry.folder }, name, entry.error ? h("small.error", { title: entry.error }, entry.error) : null);
  }
  if (value === null || value === undefined || value === "") return h("td.missing", null, "\u2013");
  if (["state", "verdict", "quality"].includes(column.key)) return h("td", null, column.key === "state" && value === "done" ? "done" : chip(value));
  if (column.kind === "gate") return h("td", null, chip(value));
  return typeof value === "number" ? h("td.number", { title: String(value) }, number_text(value)) : h("td", null, String(value));
}

export function table_section(app) {
  const { state } = app;
  const head = h("tr"), body = h("tbody");
  const sort_by = (key) => state.set(state.get("sort") === key ? { down: !state.get("down") } : { sort: key, down: false });
  const choose = (name, is_chosen) => state.set({ compare: is_chosen ? [...state.get("compare"), name] : state.get("compare").filter((entry) => entry !== name) });
  const refresh = () => {
    const { sort, down, columns, compare } = state.values;
    const shown = app.columns.filter((column) => columns.has(column.key));
    fill(
      head,
      h("th", { title: "chosen for the comparison" }, "\u2261"),
      shown.map((column) =>
        h(
          `th${column.kind === "figure" || column.kind === "parameter" ? ".number" : ""}`,
          { scope: "col", "aria-sort": sort === column.key ? (down ? "descending" : "ascending") : "none" },
          h("button.sort", { type: "button", "data-key": column.key, onclick: () => sort_by(column.key) }, column.title, column.unit ? h("small", null, ` [${column.unit}]`) : null, h("span.arrow", null, sort === column.key ? (down ? "\u25be" : "\u25b4") : "")),
        ),
      ),
    );
    fill(
      body,
      sorted_cases(app).map((entry) => {
        const box = h("input", { type: "checkbox", "data-compare": entry.name, "aria-label": `compare ${entry.name}`, checked: compare.includes(entry.name), onchange: () => choose(entry.name, box.checked) });
        return h("tr", { "data-name": entry.name, class: entry.state === "failed" || entry.verdict === "INVALID" ? "bad" : entry.state === "not run" ? "idle" : null }, h("td", null, box), shown.map((column) => cell_of(column, entry)));
      }),
    );
  };
  state.on(["sort", "down", "columns", "compare"], refresh);
  refresh();
  const boxes = app.columns.map((column) => {
    const box = h("input", { type: "checkbox", "data-column": column.key, checked: state.get("columns").has(column.key), onchange: () => {
      const next = new Set(state.get("columns"));
      if (box.checked) next.add(column.key);
      else next.delete(column.key);
      state.set({ columns: next });
    } });
    return h("label.check", null, box, h("span", null, column.title));
  });
  const none = button("clear selection", () => state.set({ compare: [] }), { kind: ".small", id: "compare_none", title: "Remove all cases from the comparison" });
  return h("section.cases", null, h("div.section_head", null, h("h2", null, "Cases"), h("details.columns", null, h("summary", null, "columns"), h("div.column_list", null, boxes)), none), h("div.scroll", null, h("table.list", { id: "cases" }, h("thead", null, head), body)));
}
