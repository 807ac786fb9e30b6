// The objects of the script, by the names of their variables: visible or hidden, with components and patches.
import { button, h, fill, number_text } from "../dom.js";
import { patch_css } from "../painting.js";

const k_kinds = { model: "model", component: "part", surface: "surface", envelope: "envelope", tetrahedra: "layer", mesh: "mesh" };

/** Returns the patches by component, in the order of the scene. */
function groups_of(scene) {
  const groups = new Map();
  scene.patches.forEach((patch, k) => {
    const name = patch.component ?? "";
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push({ ...patch, k });
  });
  return groups;
}

function patch_row(bench, key, patch, shown) {
  const box = h("input", { type: "checkbox", onchange: () => bench.show_patches(key, [patch.name], box.checked), "aria-label": `show ${patch.name}` });
  box.checked = !shown.hidden.has(patch.name);
  const only = button("only", () => {
    bench.show_patches(key, shown.scene.patches.map((p) => p.name), false);
    bench.show_patches(key, [patch.name], true);
  }, { title: `Show only ${patch.name}`, kind: ".small" });
  return h("div.tree_row.patch_row", { "data-patch": patch.name }, h("label.check", null, box, h("i.swatch", { style: { background: patch_css(patch.k) } }), h("span", null, patch.name)), h("small", { title: "area" }, `${number_text(patch.area, 3)} m\u00b2`), only);
}

function angle_text(degrees) {
  return `${number_text(degrees, 3)}\u00b0`;
}

/** Returns the sections of a wing, frames of a body and control surfaces, with their measures. A click flies to a section. */
function part_rows(bench, key, part) {
  const rows = (part?.sections ?? []).map((section) => {
    const measures = section.chord !== undefined ? [`chord ${number_text(section.chord, 3)} m`, section.twist ? `twist ${angle_text(section.twist)}` : null, section.airfoil || null] : [`${number_text(section.width, 3)} \u00d7 ${number_text(section.height, 3)} m`];
    const text = measures.filter(Boolean).join(", ");
    const fly = () => {
      bench.state.set({ chosen: key });
      bench.fly_to({ at: section.at, title: section.name, text, colour: [47, 109, 179] });
    };
    return h("div.tree_row.section_row", { "data-section": section.name }, h("button.link", { type: "button", title: `Fly to ${section.name}: ${text}`, onclick: fly }, section.name), h("small", null, text));
  });
  const controls = (part?.controls ?? []).map(({ name, angle }) => h("div.tree_row.section_row", { "data-control": name }, h("span", null, name), h("small", null, angle ? `control surface, ${angle_text(angle)}` : "control surface")));
  if (!rows.length && !controls.length) return null;
  return h("details.component.sections", { "data-component": `${part.name} sections` }, h("summary", null, h("small", null, [rows.length ? `${rows.length} ${part.sections[0].chord !== undefined ? "sections" : "frames"}` : null, controls.length ? `${controls.length} control ${controls.length === 1 ? "surface" : "surfaces"}` : null].filter(Boolean).join(", "))), rows, controls);
}

function group_rows(bench, key, name, patches, shown) {
  if (name === "") return patches.map((patch) => patch_row(bench, key, patch, shown));
  const names = patches.map((patch) => patch.name);
  const box = h("input", { type: "checkbox", onchange: () => bench.show_patches(key, names, box.checked), "aria-label": `show ${name}` });
  box.checked = names.some((n) => !shown.hidden.has(n));
  box.indeterminate = box.checked && names.some((n) => shown.hidden.has(n));
  const part = shown.scene.parts?.[name] ? part_rows(bench, key, { ...shown.scene.parts[name], name }) : null;
  if (patches.length === 1 && patches[0].name === name) return [patch_row(bench, key, patches[0], shown), part];
  const only = button("only", () => {
    bench.show_patches(key, shown.scene.patches.map((p) => p.name), false);
    bench.show_patches(key, names, true);
  }, { title: `Show only ${name}`, kind: ".small" });
  return [h("details.component", { "data-component": name }, h("summary", null, h("label.check", null, box, h("b", null, name)), only), patches.map((patch) => patch_row(bench, key, patch, shown)), part)];
}

export function tree_panel(bench) {
  const list = h("div.tree_list", { id: "tree" });
  const open = new Set(); // components that are opened
  let drawn = "", names_drawn = "", measures_drawn = "";
  /** Returns the whole content of the tree. While a slider moves, the measures stay unchanged, because sketches have none. */
  const signature = () => {
    const chosen = bench.chosen();
    const names = JSON.stringify(chosen?.scene?.patches.map((patch) => [patch.name, patch.component]));
    if (!chosen?.scene?.is_quick || names !== names_drawn) measures_drawn = JSON.stringify([chosen?.scene?.patches.map((patch) => patch.area), chosen?.scene?.parts]);
    names_drawn = names;
    const hidden = chosen ? [...chosen.hidden] : [];
    return JSON.stringify([bench.objects().map((object) => [object.key, object.kind, object.line, bench.is_shown(object), object.is_old && object.scene > 0 && !chosen?.scene?.is_quick, object.failure]), bench.state.get("chosen"), names, measures_drawn, hidden]);
  };
  const refresh = () => {
    const now = signature();
    if (now === drawn) return;
    drawn = now;
    for (const details of list.querySelectorAll("details.component")) details.open ? open.add(details.dataset.component) : open.delete(details.dataset.component);
    const rows = bench.objects().map((object) => {
      const shown = bench.view?.objects.get(object.key);
      const box = h("input", { type: "checkbox", onchange: () => bench.show(object.key, box.checked), "aria-label": `show ${object.key}` });
      box.checked = bench.is_shown(object);
      const line = object.line ? h("small", null, ` line ${object.line}`) : null;
      const name = h("button.link", { type: "button", title: object.text, onclick: () => (bench.is_shown(object) ? bench.state.set({ chosen: object.key, tab: "object" }) : bench.show(object.key, true)) }, object.key);
      const only = button("only", () => bench.isolate(object.key), { title: `Show only ${object.key}`, kind: ".small" });
      const patches = shown?.scene && object.key === bench.state.get("chosen") ? [...groups_of(shown.scene)].flatMap(([group, entries]) => group_rows(bench, object.key, group, entries, shown)) : [];
      return h(
        `div.tree_object${object.is_old && box.checked ? ".old" : ""}${object.key === bench.state.get("chosen") ? ".chosen" : ""}`,
        { "data-key": object.key },
        h("div.tree_row", null, box, name, h("span.kind", null, k_kinds[object.kind] ?? object.kind), object.is_old && object.scene && box.checked ? h("span.chip.warn", null, "old") : null, line, only),
        object.failure ? h("p.note.wrong", null, object.failure) : null,
        h("div.tree_patches", null, patches),
      );
    });
    fill(list, rows.length ? rows : h("p.note", null, "No objects yet."));
    for (const details of list.querySelectorAll("details.component")) details.open = open.has(details.dataset.component);
  };
  bench.state.on(["news", "shown", "chosen"], refresh);
  return h("section.tree_panel", null, h("h2", null, "Made by the script"), list);
}
