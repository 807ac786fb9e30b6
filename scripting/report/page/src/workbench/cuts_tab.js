// A plane that is dragged through the volume mesh. Its cells are shown as soon as the program has cut them.
import { button, count_text, fill, h, number_text } from "../dom.js";
import { select_of } from "../surface_tab.js";
import { mesh_of } from "./mesh_tab.js";

const k_around = [["clip", "cut off in front of the plane"], ["show", "whole"], ["hide", "hidden"]];
const k_steps = 400;

export function cuts_tab(bench) {
  const { state } = bench;
  const note = h("p.note");
  const axis = select_of("Plane across", "cut_axis", ["x", "y", "z"].map((name) => [name, name]), "y", () => (range(), ask()));
  const slider = h("input.slider.wide", { type: "range", min: 0, max: k_steps, step: 1, value: k_steps / 2, id: "cut_place", "aria-label": "Position of the plane", oninput: () => ask() });
  const place = h("output.cut_place", { id: "cut_place_text" });
  const colours = h("div");
  const cells = h("p.note", { id: "cut_cells" });
  const around = select_of("Surface", "cut_around", k_around, state.get("around"), (name) => state.set({ around: name }));
  const form = h("div.form", null, axis, h("div.field", null, slider, place), around, colours, cells, h("div.buttons", null, button("Look at it", () => look(), { id: "cut_look", kind: ".small" }), button("No cut", () => state.set({ cut: null }), { id: "cut_none", kind: ".small" })));
  let low = 0, high = 1, wanted = null, is_busy = false;

  /** The walls limit the movement of the plane, because a farfield is too large. */
  const range = () => {
    const mesh = mesh_of(bench);
    if (!mesh) return;
    const c = "xyz".indexOf(axis.lastChild.value);
    const { origin, length } = mesh.scene;
    const walls = mesh.set.boxes.filter((_, p) => mesh.scene.patches[p].kind === "wall" && !mesh.set.boxes[p].isEmpty());
    const least = Math.min(...walls.map((box) => box.min.getComponent(c))), most = Math.max(...walls.map((box) => box.max.getComponent(c)));
    low = origin[c] + (walls.length ? least : -length / 2) - 0.02 * length;
    high = origin[c] + (walls.length ? most : length / 2) + 0.02 * length;
  };
  const value = () => low + ((high - low) * Number(slider.value)) / k_steps;
  const ask = async () => {
    const mesh = mesh_of(bench);
    if (!mesh) return;
    range();
    wanted = `${axis.lastChild.value}=${Number(value().toPrecision(6))}`;
    place.textContent = `${axis.lastChild.value} = ${number_text(value())} m`;
    if (is_busy) return; // the latest position is requested when this cut has arrived
    is_busy = true;
    try {
      while (wanted) {
        const plane = wanted;
        wanted = null;
        if (!(await bench.cut_at(mesh.key, plane))) break;
      }
    } finally {
      is_busy = false;
    }
  };
  const look = () => {
    const { cut } = state.values;
    const mesh = mesh_of(bench);
    if (!cut || !mesh) return;
    const focus = [...mesh.scene.origin];
    const c = "xyz".indexOf(axis.lastChild.value);
    focus[c] = cut.origin[c];
    bench.view.fly_to_cut({ normal: cut.normal, focus: { center: focus, radius: mesh.scene.length * 0.55 } });
  };
  const refresh = () => {
    const mesh = mesh_of(bench);
    form.hidden = !mesh;
    note.textContent = mesh ? "Drag the plane; cells appear when they are cut." : "Only volume meshes have cells to cut: \u201cMesh now\u201d makes a volume mesh.";
    const { cut } = state.values;
    fill(colours, cut ? select_of("Colour of the cells", "cut_color", [["kind", "by kind of cell"], ...cut.fields.map((field) => [field.name, field.unit ? `${field.title} [${field.unit}]` : field.title])], state.get("cut_color"), (name) => state.set({ cut_color: name })) : null);
    cells.textContent = cut ? `${count_text(cut.n)}${cut.total > cut.n ? ` of ${count_text(cut.total)}` : ""} cells` : "";
  };
  bench.on_in_tab("cuts", ["shown", "chosen", "cut"], refresh);
  refresh();
  return [h("h2", null, "Cut through the cells"), note, form];
}
