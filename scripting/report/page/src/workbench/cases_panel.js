// The cases of a series as pictures and as a table, over the picture. A click opens the case.
import { chip, state_class } from "../banner.js";
import { button, count_text, fill, h, number_text } from "../dom.js";
import { sentence_of } from "../errors.js";
import { get_cases, get_picture, post } from "./server.js";

const k_picture_width = 320; // pixels, width of a picture that is taken from the view
const k_case_patience = 120000; // ms, time limit for reading a case while pictures are taken

function value_text(value) {
  if (typeof value === "number") return number_text(value);
  return value === null || value === undefined || typeof value === "object" ? "\u2013" : String(value);
}

/** Compares values: numbers by size, other values alphabetically; missing values come last. */
function compared(a, b) {
  const is_gap = (x) => x === undefined || x === null || x === "";
  if (is_gap(a) || is_gap(b)) return is_gap(a) - is_gap(b);
  return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), undefined, { numeric: true });
}

export class CasesPanel {
  constructor(bench) {
    this.bench = bench;
    this.cases = [];
    this.pictures = new Map(); // address of a picture by the name of the case
    this.sort = { key: null, is_down: false };
    this.grid = h("div.case_grid", { id: "case_grid" });
    this.table = h("table.list", { id: "case_table" });
    this.take = button("Take pictures of all", () => this.take_all(), { title: "Opens each case once and stores its picture from the current camera position", id: "take_pictures", kind: ".small" });
    this.element = h("div.cases_panel", { id: "cases_panel", role: "region", "aria-label": "Cases of the series" }, h("h2", null, "Cases ", h("span.h2_buttons", null, this.take, button("Close", () => this.show(false), { title: "Back to the picture (key C)", id: "cases_close", kind: ".small" }))), this.grid, h("div.scroll", null, this.table));
    bench.state.on(["is_in_cases"], ({ is_in_cases }) => (this.element.hidden = !is_in_cases));
    bench.state.on(["news"], () => this.mark());
  }

  async load() {
    this.cases = await get_cases();
    for (const entry of this.cases) if (entry.picture !== null) get_picture(entry.picture).then((address) => this.keep(entry.name, address)).catch((error) => this.bench.say_for_a_while(sentence_of(error)));
    this.draw();
  }

  show(is_shown) {
    this.bench.state.set({ is_in_cases: is_shown });
  }

  /** Returns the number in the script of the case in the picture; null if there is none. */
  current() {
    const { news } = this.bench.state.values;
    const asked = Number(news?.values.case ?? 1);
    return Number.isFinite(asked) ? Math.floor(asked + 0.5) : null;
  }

  open(entry) {
    if (entry.case === null) return;
    this.show(false);
    this.choose(entry).catch((error) => this.bench.say_for_a_while(sentence_of(error)));
  }

  async choose(entry) {
    if (this.current() !== entry.case) await post("values", { values: { case: String(entry.case) } });
  }

  keep(name, address) {
    this.pictures.set(name, address);
    this.draw_grid();
  }

  /** Takes the picture of the visible case from the view. */
  async keep_view() {
    const entry = this.cases.find((known) => known.case === this.current());
    if (entry) this.keep(entry.name, await this.bench.view.thumbnail(k_picture_width));
  }

  async take_all() {
    const first = this.current();
    this.take.disabled = true;
    try {
      for (const entry of this.cases.filter((known) => known.case !== null)) {
        await this.choose(entry);
        await this.bench.is_shown_as((news) => this.current() === entry.case && news.run.status === "done", k_case_patience);
        await this.keep_view();
      }
      const before = this.cases.find((known) => known.case === first);
      if (before) await this.choose(before);
    } catch (error) {
      this.bench.say_for_a_while(sentence_of(error));
    } finally {
      this.take.disabled = false;
    }
  }

  // ---- Drawing

  columns() {
    const names = (member) => [...new Set(this.cases.flatMap((entry) => Object.keys(entry[member] ?? {})))];
    const plain = [
      { key: "name", title: "case", of: (entry) => entry.name },
      ...names("parameters").filter((name) => name !== "name").map((name) => ({ key: `p_${name}`, title: name, of: (entry) => entry.parameters?.[name] })),
      { key: "status", title: "status", of: (entry) => entry.status },
      { key: "verdict", title: "mesh", is_state: true, of: (entry) => entry.verdict },
      { key: "cells", title: "cells", of: (entry) => entry.cells },
    ];
    const gates = names("gates").sort((a, b) => a.localeCompare(b, "en", { numeric: true })).map((name) => ({ key: `g_${name}`, title: name, is_state: true, of: (entry) => entry.gates[name] }));
    return [...plain, ...gates];
  }

  draw() {
    this.draw_grid();
    this.draw_table();
  }

  draw_grid() {
    fill(
      this.grid,
      this.cases.map((entry) => {
        const address = this.pictures.get(entry.name);
        const why = entry.case === null ? (entry.error?.message ?? "no mesh") : "no picture yet";
        return h(
          `button.case_card.${state_class(entry.quality ?? entry.verdict ?? "FAIL")}`,
          { type: "button", "data-case": entry.name, disabled: entry.case === null, title: entry.case === null ? why : `Open ${entry.name}`, onclick: () => this.open(entry) },
          address ? h("img", { src: address, alt: `Picture of ${entry.name}` }) : h("span.no_picture", null, why),
          h("b", null, entry.name),
          h("span.case_states", null, entry.verdict ? chip(entry.verdict) : chip(entry.status), entry.quality ? chip(entry.quality.split(/[:;,]/)[0], entry.quality) : null, typeof entry.cells === "number" ? h("small", null, ` ${count_text(entry.cells)} cells`) : null),
        );
      }),
    );
    this.mark();
  }

  draw_table() {
    const columns = this.columns();
    const { key, is_down } = this.sort;
    const by = columns.find((column) => column.key === key);
    const rows = by ? [...this.cases].sort((a, b) => (is_down ? -1 : 1) * compared(by.of(a), by.of(b))) : this.cases;
    const sort_by = (name) => {
      this.sort = { key: name, is_down: key === name && !is_down };
      this.draw_table();
    };
    fill(
      this.table,
      h("thead", null, h("tr", null, columns.map((column) => h("th", { scope: "col", "aria-sort": key === column.key ? (is_down ? "descending" : "ascending") : "none" }, h("button.sort", { type: "button", "data-key": column.key, onclick: () => sort_by(column.key) }, column.title))))),
      h("tbody", null, rows.map((entry) => h("tr", { "data-case": entry.name }, columns.map((column) => this.cell(column, entry))))),
    );
    this.mark();
  }

  cell(column, entry) {
    const value = column.of(entry);
    if (column.key === "name") return h("td.case_name", null, h("button.link", { type: "button", disabled: entry.case === null, title: entry.error?.message ?? entry.quality ?? "", onclick: () => this.open(entry) }, entry.name));
    if (column.is_state) return h("td", null, value ? chip(value) : "\u2013");
    return h(`td${typeof value === "number" ? ".number" : ""}`, null, value_text(value));
  }

  /** Marks the case that is in the picture. */
  mark() {
    const shown = this.cases.find((entry) => entry.case !== null && entry.case === this.current())?.name;
    for (const element of this.element.querySelectorAll("[data-case]")) element.classList.toggle("current", element.dataset.case === shown);
  }
}
