// Verdict, gates and worst locations of the selected volume mesh.
import { chip, state_class, state_colour } from "../banner.js";
import { fill, h, number_text, position_text, quantity_text } from "../dom.js";
import { place_text, place_title } from "../places_tab.js";

/** Returns the volume mesh of the panels: the selected object, or the last volume mesh. */
export function mesh_of(bench) {
  const chosen = bench.chosen();
  if (chosen?.scene?.kind === "volume") return chosen;
  return [...(bench.view?.objects.values() ?? [])].filter((shown) => shown.scene?.kind === "volume").at(-1) ?? null;
}

function gate_row(gate) {
  const limit = typeof gate.limits?.hard === "number" ? h("span.limit", null, h("small", null, "hard"), ` ${number_text(gate.limits.hard)}`) : null;
  return h("div.gate.quality", { "data-gate": gate.gate }, h("span.gate_name", null, gate.gate), h("span.gate_title", null, gate.title), chip(gate.state), gate.state === "not checked" || gate.worst === undefined ? null : h("div.gate_more", null, h("span.worst", null, h("small", null, "worst"), ` ${quantity_text(gate.worst, gate.unit)}`), limit));
}

export function mesh_tab(bench) {
  const body = h("div", { id: "mesh_tab" });
  const refresh = () => {
    const mesh = mesh_of(bench);
    if (!mesh) return fill(body, h("p.note", null, "There is no volume mesh yet. \u201cMesh now\u201d runs the whole script: surfaces and volumes are meshed, files are written."));
    const { scene } = mesh;
    fill(
      body,
      h("h2", null, mesh.key, " ", chip(scene.verdict), chip(scene.quality_verdict)),
      h("table.facts", null, h("tbody", null, scene.facts.map(([name, text]) => h("tr", null, h("th", { scope: "row" }, name), h("td", null, text))))),
      h("h2", null, "Gates"),
      scene.gates.map(gate_row),
      h("h2", null, "Worst locations"),
      h(
        "div.rows",
        null,
        scene.places.map((place, k) =>
          h(`button.row.place.${state_class(place.state)}`, { type: "button", id: `place_${k}`, onclick: () => fly(bench, mesh, place) }, h("span.place_value", null, typeof place.value === "number" ? quantity_text(place.value, place.unit) : place.state), h("span.place_what", null, `${place_title(place)}: ${place.what}`, h("small", null, ` at ${position_text(place.at)}`))),
        ),
      ),
    );
  };
  bench.on_in_tab("mesh", ["shown", "chosen"], refresh);
  refresh();
  return body;
}

function fly(bench, mesh, place) {
  if (bench.state.get("chosen") !== mesh.key) bench.state.set({ chosen: mesh.key });
  bench.fly_to({ at: place.at, title: place_title(place), text: place_text(place), colour: state_colour(place.state) });
}
