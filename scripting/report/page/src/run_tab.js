// How the mesh was made: stages, memory, inputs, options.
import { bytes_text, count_text, fill, h, number_text, percent_text, seconds_text } from "./dom.js";

const k_most_entries = 50; // number of entries of a manifest list that are shown, followed by the number of the others

function stages(run) {
  const total = run.seconds || run.stages.filter((stage) => !stage.depth).reduce((sum, stage) => sum + stage.seconds, 0) || 1;
  const rows = run.stages.map((stage) => {
    const share = stage.seconds / total;
    return h("tr", null, h("td", { style: { paddingLeft: `${0.4 + 1.1 * (stage.depth ?? 0)}em` } }, stage.name.split("/").pop(), h("small", null, stage.name.includes("/") && !stage.depth ? ` ${stage.name}` : "")), h("td.number", null, seconds_text(stage.seconds)), h("td.share_cell", null, h("span.share", { title: percent_text(share) }, h("i", { style: { width: `${Math.min(100, 100 * share).toFixed(2)}%` } }))), h("td.number", null, `${(100 * share).toFixed(1)} %`), h("td.number", null, stage.busy === undefined ? "" : `${(100 * stage.busy).toFixed(0)} %`));
  });
  const facts = [["time", seconds_text(run.seconds)], ["peak memory", bytes_text(run.peak_memory)], ["threads", number_text(run.threads)]];
  return [h("h2", null, "Stages"), h("div.figures", null, facts.map(([name, value]) => h("span", null, h("b", null, value), h("small", null, name)))), h("table.list", null, h("thead", null, h("tr", null, h("th", null, "stage"), h("th.number", null, "time"), h("th"), h("th.number", null, "share"), h("th.number", { title: "processor time used during the stage, relative to the capacity of all threads" }, "busy"))), h("tbody", null, rows))];
}

function value_text(value) {
  if (value === "") return "\u2013";
  if (typeof value === "number") return number_text(value, 7);
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

/** Returns the names of options that differ from their defaults, by stage: {stage: Set}; null if the manifest has no defaults. */
function changed_options(report) {
  const table = report.options_set ?? report.manifest?.options_set;
  return table ? new Map(Object.entries(table).map(([stage, names]) => [stage, new Set(names)])) : null;
}

function options(app) {
  const { report } = app;
  const changed = changed_options(report);
  const entries = Object.entries(report.manifest.options ?? {}).flatMap(([stage, list]) => Object.entries(list).map(([name, value]) => ({ stage, name, value, is_changed: Boolean(changed?.get(stage)?.has(name)) })));
  if (!entries.length) return null;
  const body = h("div");
  const found = h("small");
  const search = h("input", { type: "search", id: "options_search", placeholder: "search options and values", "aria-label": "search options" });
  const only = h("input", { type: "checkbox", id: "options_changed" });
  const refresh = () => {
    const text = search.value.trim().toLowerCase();
    const shown = entries.filter((e) => (!text || `${e.stage} ${e.name} ${value_text(e.value)}`.toLowerCase().includes(text)) && (!only.checked || e.is_changed));
    found.textContent = ` ${shown.length} of ${entries.length}`;
    const stages_shown = [...new Set(shown.map((e) => e.stage))];
    fill(body, stages_shown.map((stage) => [h("h3", null, stage), h("table.options", null, h("tbody", null, shown.filter((e) => e.stage === stage).map((e) => h("tr", { class: e.is_changed ? "changed" : null, title: e.is_changed ? "differs from the default" : null }, h("th", { scope: "row" }, e.name), h("td", null, value_text(e.value))))))]));
  };
  search.addEventListener("input", refresh);
  only.addEventListener("change", refresh);
  refresh();
  return [h("h2", null, "Options", found), h("div.form", null, search, changed ? h("label.check", { for: "options_changed" }, only, h("span", null, "only options that differ from their defaults")) : null), body, h("p.note", null, "Lengths in metres, angles in radians.")];
}

/** Returns a value of the manifest as nested lists that can be opened. */
function tree(name, value) {
  if (value === null || typeof value !== "object") return h("div.leaf", null, h("span", null, name), h("code", null, value_text(value)));
  const list = Object.entries(value);
  if (list.length && list.length <= 4 && list.every(([, entry]) => entry === null || typeof entry !== "object") && Array.isArray(value)) return h("div.leaf", null, h("span", null, name), h("code", null, value.map((x) => value_text(x)).join(", ")));
  const body = h("div.branch");
  const details = h("details", null, h("summary", null, name, h("small", null, ` ${Array.isArray(value) ? `${count_text(list.length)} entries` : ""}`)), body);
  details.addEventListener("toggle", () => {
    if (!details.open || body.firstChild) return;
    fill(body, list.slice(0, k_most_entries).map(([key, entry]) => tree(Array.isArray(value) ? `${Number(key) + 1}` : key, entry)), list.length > k_most_entries ? h("p.note", null, `and ${count_text(list.length - k_most_entries)} more in the manifest`) : null);
  });
  return details;
}

const k_shown_apart = ["schema", "program", "output", "seed", "inputs", "options", "verdict", "quality", "options_set", "changes"];

export function run_tab(app) {
  const { run, manifest } = app.report;
  const inputs = manifest?.inputs ?? [];
  const facts = manifest ? [["version", manifest.program], ["seed", manifest.seed], ["output", manifest.output]].filter(([, value]) => value !== undefined) : [];
  return [
    run ? stages(run) : h("p.note", null, "The mesh was read from a file: there is no record of stages."),
    manifest
      ? [
          h("h2", null, "Inputs"),
          h("table.facts", null, h("tbody", null, facts.map(([name, value]) => h("tr", null, h("th", { scope: "row" }, name), h("td", null, String(value)))))),
          inputs.length ? h("table.list", null, h("thead", null, h("tr", null, h("th", null, "file"), h("th", null, "xxh3-128"))), h("tbody", null, inputs.map((input) => h("tr", null, h("td", null, input.file), h("td", null, h("code.hash", null, input.xxh3_128 ?? "")))))) : h("p.note", null, "No input files."),
          options(app),
          h("h2", null, "The rest of the manifest"),
          h("div.tree", null, Object.entries(manifest).filter(([name]) => !k_shown_apart.includes(name)).map(([name, value]) => tree(name, value))),
        ]
      : null,
  ];
}
