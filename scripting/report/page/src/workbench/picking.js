// The item under the pointer, two picks with their distance, and the picked item as Lua.
import { button, count_text, fill, h, number_text, position_text, quantity_text } from "../dom.js";
import { k_kinds } from "../colours.js";

const k_digits = 3; // number of digits of lengths that become options

/** Returns the lengths of the edges of a triangle in the drawn set. */
function edge_lengths(set, t) {
  const [a, b, c] = set.corners(t);
  return [a.distanceTo(b), b.distanceTo(c), c.distanceTo(a)];
}

/** Returns a rule of surface_mesh for the patch, with the picked edge length, or a third of the size of the patch. */
export function lua_of(pick) {
  const key = pick.kind === "model" ? Math.sqrt(Math.max(pick.area, 0)) / 20 : pick.edges.reduce((sum, length) => sum + length, 0) / 3;
  return `patches = { [${JSON.stringify(pick.patch)}] = { max_edge = ${Number(key.toPrecision(k_digits))} } }`;
}

export class Picking {
  constructor(bench) {
    this.bench = bench;
    this.picks = [];
    this.line = h("div.pick_line", { hidden: true }, h("span"));
    this.rings = [0, 1].map((k) => h("div.pick_ring", { hidden: true }, String(k + 1)));
    bench.view_box.append(this.line, ...this.rings);
  }

  show(found, is_click) {
    const { bench } = this;
    if (is_click && found) {
      this.picks = [...this.picks.slice(-1), this.describe(found)];
      fill(bench.kept, this.lines(this.picks.at(-1), true));
      bench.kept.hidden = false;
    } else if (is_click) return this.clear();
    bench.info.hidden = !found || is_click;
    if (!bench.info.hidden) fill(bench.info, this.lines(this.describe(found), false));
    if (is_click) bench.view.request();
  }

  describe(found) {
    if (found.layer === "cut") return this.describe_cell(found);
    const shown = this.bench.view.objects.get(found.key);
    const { scene, set } = found.picture === 0 && this.bench.view.is_split ? shown.previous : shown.drawn;
    const patch = scene.patches[scene.surface.patch[found.item]];
    return { key: found.key, at: found.at, picture: found.picture, item: found.item, kind: scene.kind, patch: patch.name, component: patch.component, role: patch.role, patch_kind: patch.kind, area: patch.area, edges: edge_lengths(set, found.triangle), fields: scene.surface.fields.map((field) => [field, field.values[found.item]]) };
  }

  /** Describes a picked cell of the cut; the position is on the plane of the cut. */
  describe_cell({ item, at, picture }) {
    const { cut } = this.bench.state.values;
    return { key: null, at, item, picture, kind: "cell", name: k_kinds[cut.kind[item]]?.one ?? "cell", fields: cut.fields.map((field) => [field, field.values[item]]) };
  }

  lines(pick, is_kept) {
    if (pick.kind === "cell") return this.cell_lines(pick, is_kept);
    const of = [pick.component && pick.component !== pick.patch ? pick.component : null, pick.role && pick.role !== "unknown" ? pick.role.replaceAll("_", " ") : null, pick.patch_kind].filter(Boolean).join(", ");
    const edges = pick.kind === "model" ? null : h("span", null, h("small", null, "edges"), pick.edges.map((length) => number_text(length, 3)).join(", "), " m");
    const measured = is_kept ? this.measured() : null;
    const buttons = is_kept ? h("div.buttons.pick_buttons", null, button("Copy as Lua", () => this.copy(lua_of(pick)), { title: lua_of(pick), kind: ".small", id: "copy_lua" }), this.place_button(pick), button("Hide", () => this.hide_patch(), { title: "Hide this patch (key H)", kind: ".small", id: "hide_patch" })) : null;
    return [
      h("div", null, h("b", null, pick.patch), h("small", null, ` ${of} \u00b7 ${pick.key} \u00b7 ${pick.kind === "model" ? "" : `triangle ${count_text(pick.item)} \u00b7 `}at ${position_text(pick.at)} m`)),
      h("div.info_values", null, edges, pick.fields.filter(([, value]) => Number.isFinite(value)).map(([field, value]) => h("span", null, h("small", null, field.title), quantity_text(value, field.unit)))),
      measured,
      buttons,
    ];
  }

  distance_line(one, other) {
    const d = other.at.map((x, c) => x - one.at[c]);
    return h("div.distance", { id: "distance" }, h("b", null, `${number_text(Math.hypot(...d), 5)} m`), h("small", null, ` from pick 1 to 2: \u0394 ${position_text(d)} m`));
  }

  cell_lines(pick, is_kept) {
    const fields = pick.fields.filter(([, value]) => Number.isFinite(value)).map(([field, value]) => h("span", null, h("small", null, field.title), quantity_text(value, field.unit)));
    return [h("div", null, h("b", null, pick.name), h("small", null, ` at ${position_text(pick.at)} m`)), h("div.info_values", null, fields), is_kept ? [this.measured(), h("div.buttons.pick_buttons", null, this.place_button(pick))] : null];
  }

  /** Returns the distance of two picks, of surfaces, cells, or one of each. */
  measured() {
    const [one, other] = this.picks;
    return other ? this.distance_line(one, other) : null;
  }

  place_button(pick) {
    return button("Copy position", () => this.copy(`{ ${pick.at.map((x) => Number(x.toPrecision(7))).join(", ")} }`), { kind: ".small", id: "copy_place" });
  }

  /** Rings at the picks and the line between them follow the camera. */
  draw() {
    const at = this.picks.map((pick) => this.bench.view.on_screen(pick.at, pick.picture));
    this.rings.forEach((ring, k) => {
      ring.hidden = !at[k];
      if (at[k]) ring.style.transform = `translate(${at[k][0].toFixed(1)}px, ${at[k][1].toFixed(1)}px)`;
    });
    this.line.hidden = !(at[0] && at[1]);
    if (this.line.hidden) return;
    const dx = at[1][0] - at[0][0], dy = at[1][1] - at[0][1];
    this.line.style.width = `${Math.hypot(dx, dy).toFixed(1)}px`;
    this.line.style.transform = `translate(${at[0][0].toFixed(1)}px, ${at[0][1].toFixed(1)}px) rotate(${Math.atan2(dy, dx)}rad)`;
  }

  async copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      this.bench.say_for_a_while(`Copied: ${text}`);
    } catch {
      this.bench.say_for_a_while(`This browser does not allow pages to copy. The text is: ${text}`);
    }
    this.copied = text;
  }

  hide_patch() {
    const pick = this.picks.at(-1);
    if (!pick?.key) return;
    this.bench.show_patches(pick.key, [pick.patch], false);
    this.clear();
  }

  clear() {
    this.picks = [];
    this.bench.kept.hidden = this.bench.info.hidden = true;
    this.bench.view.set_pin(null);
    this.bench.view.request();
  }
}
