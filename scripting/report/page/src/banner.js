// The line at the top: input, verdict, and the most important quantities.
import { count_text, h } from "./dom.js";

const k_state_colours = { pass: [63, 148, 98], warn: [214, 150, 40], fail: [204, 64, 52], invalid: [150, 20, 70], "not checked": [128, 132, 140] };

/** Returns [r, g, b] of a state ("pass", "warn", "fail", "FAIL", "invalid", "INVALID", ...). */
export function state_colour(state) {
  return k_state_colours[String(state).toLowerCase()] ?? k_state_colours["not checked"];
}

/** Returns the style class of a state: "pass", "warn", "fail", "invalid", "unknown". If there are several states ("FAIL: G6 G7; warn: G5", "pass, 3 forced"), the first state counts, which is the worst. */
export function state_class(state) {
  const name = String(state).toLowerCase().split(/[:;,]/)[0].split(" at ")[0];
  if (name === "valid") return "pass";
  if (name === "failed") return "fail";
  return ["pass", "warn", "fail", "invalid"].includes(name) ? name : "unknown";
}

export function chip(state, title) {
  return h(`span.chip.${state_class(state)}`, { title }, String(state));
}

export function banner({ report }) {
  const facts = (report.facts ?? []).slice(0, 5).map(([name, value]) => h("span.fact", null, h("b", null, value), ` ${name}`));
  const surface = report.surface;
  const thinned = surface && surface.shown < surface.total
    ? h("span.fact.thinned", { title: "The report contains a part of the surface's triangles; tables and histograms describe the whole mesh." }, `picture thinned: ${count_text(surface.shown)} of ${count_text(surface.total)} triangles`)
    : null;
  return h(
    "header.banner",
    null,
    h("div.banner_title", null, h("h1", null, report.title), h("span.program", null, report.program)),
    h("div.banner_facts", null, facts, thinned),
    h(
      "div.verdicts",
      null,
      h(`div.verdict.${state_class(report.verdict)}`, { id: "verdict", title: "Every face matched, every cell valid, nothing intersects" }, h("small", null, "mesh"), report.verdict),
      h(`div.verdict.${state_class(report.quality_verdict)}`, { id: "quality_verdict", title: report.verdict_line ?? "Worst state of the quality gates" }, h("small", null, "quality"), report.quality_verdict),
    ),
  );
}
