// The page of a series: a table of the cases, a chart of a quantity over a parameter, and cases side by side.
import { require_tables } from "./data.js";
import { fill, h } from "./dom.js";
import { chip } from "./banner.js";
import { read_hash, State, write_hash } from "./state.js";
import { compare_section } from "./series_compare.js";
import { chart_section } from "./series_chart.js";
import { table_section } from "./series_table.js";

/** Returns a parameter as number or text; other Lua values become text. */
function plain(value) {
  if (value === null || value === undefined || typeof value === "number" || typeof value === "string") return value;
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

/** Returns the columns: {key, title, unit, kind: "parameter" | "figure" | "gate" | "word", of(case)}. */
function columns_of(series) {
  const gates = [...new Set(series.cases.flatMap((entry) => Object.keys(entry.gates ?? {})))].sort((a, b) => a.localeCompare(b, "en", { numeric: true }));
  return [
    { key: "name", title: "case", kind: "word", of: (c) => c.name },
    ...series.parameters.map((name) => ({ key: `p:${name}`, title: name, kind: "parameter", of: (c) => plain(c.parameters?.[name]) })),
    { key: "state", title: "state", kind: "word", of: (c) => c.state },
    { key: "verdict", title: "mesh", kind: "word", of: (c) => c.verdict },
    { key: "quality", title: "quality", kind: "word", of: (c) => c.quality },
    ...series.figures.map((figure) => ({ key: `f:${figure.name}`, title: figure.title ?? figure.name, unit: figure.unit ?? "", is_log: Boolean(figure.is_log), kind: "figure", of: (c) => c.figures?.[figure.name] })),
    ...gates.map((gate) => ({ key: `g:${gate}`, title: gate, kind: "gate", of: (c) => c.gates?.[gate] })),
    { key: "reused", title: "reused", kind: "word", of: (c) => (c.reused ?? []).join(", ") },
  ];
}

export class SeriesApp {
  constructor(series) {
    this.series = series;
    require_tables(series, ["parameters", "figures", "cases"]);
    this.columns = columns_of(series);
    const hash = read_hash();
    const keys = new Set(this.columns.map((column) => column.key));
    const usable = series.cases.filter((entry) => entry.state === "done").map((entry) => entry.name);
    const listed = (text, known) => text?.split(",").filter((entry) => known.has(entry));
    this.state = new State({
      sort: keys.has(hash.sort) ? hash.sort : "",
      down: hash.down === "1",
      columns: new Set(listed(hash.columns, keys) ?? [...keys]),
      compare: hash.compare?.split(",").map((k) => series.cases[Number(k)]?.name).filter(Boolean) ?? usable.slice(0, 2),
      figure: keys.has(hash.figure) ? hash.figure : this.columns.find((column) => column.kind === "figure")?.key ?? "",
      over: series.parameters.includes(hash.over) ? hash.over : series.parameters[0] ?? "",
      by: series.parameters.includes(hash.by) ? hash.by : (series.parameters[1] ?? ""),
    });
  }

  async start(root) {
    const { series, state } = this;
    document.title = `${series.title} \u2013 sterna series`;
    fill(root, h("div.series", null, this.banner(), h("main", null, h("div.series_top", null, table_section(this), chart_section(this)), compare_section(this))));
    state.on(null, () => write_hash(() => this.hash_entries()));
    window.addEventListener("hashchange", () => location.reload());
  }

  hash_entries() {
    const { sort, down, columns, compare, figure, over, by } = this.state.values;
    return { sort, down: down ? 1 : null, columns: columns.size === this.columns.length ? null : [...columns].join(","), compare: compare.map((name) => this.series.cases.findIndex((entry) => entry.name === name)).join(",") || "none", figure, over, by };
  }

  banner() {
    const { cases } = this.series;
    const count = (test) => cases.filter(test).length;
    const parts = [
      [count((c) => c.verdict === "VALID"), "VALID", "pass"],
      [count((c) => c.verdict === "INVALID"), "INVALID", "invalid"],
      [count((c) => c.state === "failed"), "failed", "fail"],
      [count((c) => c.state === "not run"), "not run", "not checked"],
    ];
    return h("header.banner", null, h("div.banner_title", null, h("h1", null, this.series.title), h("span.program", null, this.series.program)), h("div.banner_facts", null, h("span.fact", null, h("b", null, String(cases.length)), " cases"), parts.filter(([n]) => n > 0).map(([n, name, state]) => h("span.fact", null, h("b", null, String(n)), " ", chip_of(name, state)))));
  }

  test_state() {
    const values = { ...this.state.values, columns: [...this.state.values.columns] };
    return { schema: this.series.schema, values, rows: [...document.querySelectorAll("#cases tbody tr")].map((row) => row.dataset.name), n_points: this.n_points ?? 0, n_lines: this.n_lines ?? 0 };
  }
}

function chip_of(name, state) {
  const element = chip(state);
  element.textContent = name;
  return element;
}
