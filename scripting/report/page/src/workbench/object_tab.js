// Measures of the selected object.
import { count_text, fill, h, number_text } from "../dom.js";

export function object_tab(bench) {
  const body = h("div", { id: "object_tab" });
  const refresh = () => {
    const shown = bench.chosen();
    const object = bench.object(bench.state.get("chosen"));
    if (!shown?.scene || !object) return fill(body, h("p.note", null, "Select an object in the tree on the left."));
    const { scene } = shown;
    const { surface } = scene;
    const patches = scene.patches.filter((patch) => patch.triangles > 0);
    fill(
      body,
      h("h2", null, object.key, h("small", null, object.verb ? ` ${object.verb}{}` : "", object.line ? `, line ${object.line}` : "")),
      h("p.note", null, object.text),
      scene.is_quick ? h("p.note", { id: "sketch_note" }, "A sketch: solids are shown separately until they are united.") : null,
      surface.shown < surface.total ? h("p.note.thinned", null, `The picture is thinned: ${count_text(surface.shown)} of ${count_text(surface.total)} triangles.`) : null,
      h("table.facts", null, h("tbody", null, scene.facts.map(([name, text]) => h("tr", null, h("th", { scope: "row" }, name), h("td", null, text))))),
      scene.components?.length
        ? [h("h2", null, "Components"), h("table.list", null, h("thead", null, h("tr", null, h("th", null, "component"), h("th", null, "kind"), h("th.number", null, "wetted m\u00b2"), h("th.number", null, "volume m\u00b3"))), h("tbody", null, scene.components.map((part) => h("tr", null, h("td", null, part.name), h("td", null, part.kind), h("td.number", null, number_text(part.area)), h("td.number", null, part.volume === null ? "open" : number_text(part.volume))))))]
        : null,
      h("h2", null, "Patches"),
      h("table.list", null, h("thead", null, h("tr", null, h("th", null, "patch"), h("th", null, "kind"), h("th.number", null, "area m\u00b2"), scene.kind === "model" ? null : h("th.number", null, "triangles"))), h("tbody", null, patches.map((patch) => h("tr", null, h("td", null, patch.name), h("td", null, patch.kind), h("td.number", null, number_text(patch.area)), scene.kind === "model" ? null : h("td.number", null, count_text(patch.triangles)))))),
    );
  };
  bench.on_in_tab("object", ["shown", "chosen"], refresh);
  refresh();
  return body;
}
