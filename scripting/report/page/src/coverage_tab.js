// The share of each wall that has the requested layer, and the reasons of lower layers.
import { h, number_text, percent_text } from "./dom.js";

const k_parts = [["full", "full height"], ["reduced", "reduced"], ["compressed", "compressed"], ["collapsed", "collapsed"]];

function bar(entry) {
  return h("div.stack", { role: "img", "aria-label": k_parts.map(([name, title]) => `${title} ${percent_text(entry[name])}`).join(", ") }, k_parts.map(([name, title]) => (entry[name] > 0 ? h(`i.${name}`, { style: { width: `${(100 * entry[name]).toFixed(3)}%` }, title: `${title} ${percent_text(entry[name])}` }) : null)));
}

function reasons(entry) {
  const list = [...(entry.lost ?? [])].sort((a, b) => b[1] - a[1]);
  return list.length ? h("ul.reasons", null, list.map(([reason, share]) => h("li", null, h("span", null, percent_text(share)), ` ${reason === "none" ? "no reason recorded" : reason}`))) : null;
}

/** Returns the coverage of all patches together, weighted by area. */
function together(list) {
  const area = list.reduce((sum, entry) => sum + entry.area, 0);
  const total = { patch: "all walls", area };
  for (const [name] of k_parts) total[name] = list.reduce((sum, entry) => sum + entry.area * entry[name], 0) / area;
  const lost = new Map();
  for (const entry of list) for (const [reason, share] of entry.lost ?? []) lost.set(reason, (lost.get(reason) ?? 0) + (share * entry.area) / area);
  total.attainable = list.reduce((sum, entry) => sum + entry.area * entry.attainable, 0) / area;
  total.lost = [...lost];
  return total;
}

export function coverage_tab({ report }) {
  const list = report.coverage.length > 1 ? [together(report.coverage), ...report.coverage] : report.coverage;
  const rows = list.map((entry) => h("div.coverage", null, h("div.coverage_head", null, h("b", null, entry.patch), h("small", null, `${number_text(entry.area)} m\u00b2`), h("span", null, `${percent_text(entry.full)} of ${percent_text(entry.attainable)} attainable`)), bar(entry), reasons(entry)));
  return [h("h2", null, "Layer coverage of the walls"), h("div.keys", null, k_parts.map(([name, title]) => h("span", null, h(`i.${name}`), title))), rows, h("p.note", null, "Shares of the area. Full height: along the wall's normal at least 0.9 of the target height. Attainable: where gaps and corners of the walls permit it. Compressed: lower than layers \u00d7 first height. Collapsed: without layers.")];
}
