// The findings of inspect{} on the selected surface, with locations for camera flights.
import { state_colour } from "../banner.js";
import { button, count_text, fill, h, position_text } from "../dom.js";
import { sentence_of } from "../errors.js";
import { get_inspection } from "./server.js";

const k_states = { error: "fail", warn: "warn", note: "unknown" }; // severities as states, whose colours they have

/** Returns the surface of the panel: the selected object, or the last surface. */
function surface_of(bench) {
  const chosen = bench.chosen();
  if (chosen?.scene?.kind === "surface") return chosen;
  return [...(bench.view?.objects.values() ?? [])].filter((shown) => shown.scene?.kind === "surface").at(-1) ?? null;
}

function finding_element(bench, surface, finding, number) {
  const state = k_states[finding.severity] ?? "pass";
  const fly = (place) => {
    if (bench.state.get("chosen") !== surface.key) bench.state.set({ chosen: surface.key });
    bench.fly_to({ at: place.at, title: finding.kind.replaceAll("_", " "), text: place.what, colour: state_colour(state) });
  };
  return h(
    `section.finding.${state}`,
    { "data-finding": finding.kind },
    h("h3", null, h(`span.chip.${state}`, null, finding.severity), ` ${finding.kind.replaceAll("_", " ")}`, finding.count > 1 ? h("small", null, ` ${count_text(finding.count)}`) : null),
    h("p", null, finding.text),
    finding.advice ? h("p.note", null, `Try: ${finding.advice}`) : null,
    h("div.rows", null, finding.places.map((place, k) => h(`button.row.place.${state}`, { type: "button", id: `finding_${number}_${k}`, onclick: () => fly(place) }, h("span.place_what", null, place.what, h("small", null, ` ${place.patch ? `on ${place.patch} ` : ""}at ${position_text(place.at)}`))))),
  );
}

export function inspect_tab(bench) {
  const known = new Map(); // findings by scene
  const body = h("div", { id: "inspect_tab" });
  const refresh = () => {
    const surface = surface_of(bench);
    if (!surface) return fill(body, h("p.note", null, "There is no triangulated surface yet: \u201cMesh now\u201d makes the surfaces of the script."));
    const report = known.get(surface.scene);
    const ask = async () => {
      start.disabled = true;
      try {
        known.set(surface.scene, await get_inspection(surface.key));
        refresh();
      } catch (error) {
        bench.say_for_a_while(sentence_of(error));
        start.disabled = false;
      }
    };
    const start = button("Inspect", ask, { title: "Predict how volume_mesh will treat this surface, without layers", id: "inspect_start", kind: ".small" });
    fill(
      body,
      h("h2", null, surface.key, report ? [" ", h(`span.chip.${report.ok ? "pass" : "fail"}`, null, report.ok ? "volume_mesh will accept it" : "volume_mesh will refuse it")] : null),
      report ? null : [h("p.note", null, "Finds defects of the surface: gaps, crossings, sliver triangles, thin and narrow regions. To inspect layers, use inspect{ wall, layers = 30, first_height = 1e-5 } in the script."), h("div.buttons", null, start)],
      report?.findings.map((finding, k) => finding_element(bench, surface, finding, k)) ?? null,
      report && !report.findings.length ? h("p.note", null, "No findings.") : null,
    );
  };
  bench.on_in_tab("inspect", ["shown", "chosen"], refresh);
  refresh();
  return body;
}
