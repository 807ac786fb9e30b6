// The page of one mesh: the view on the left, a panel with tabs on the right.
import { Sphere, Vector3 } from "three";
import { k_kinds, k_maps, has_limits, range_of } from "./colours.js";
import { Arrays, read_blob, read_cut, read_surface, require_tables } from "./data.js";
import { button, count_text, fill, h, number_text, position_text, quantity_text } from "./dom.js";
import { ReportError, sentence_of } from "./errors.js";
import { banner, state_colour } from "./banner.js";
import { field_range, paint_field, paint_kinds, paint_patches, patches_legend, range_of_most, shown_values } from "./painting.js";
import { read_hash, State, write_hash } from "./state.js";
import { coverage_tab } from "./coverage_tab.js";
import { cuts_tab } from "./cuts_tab.js";
import { histograms_tab } from "./histograms_tab.js";
import { places_tab, place_text, place_title } from "./places_tab.js";
import { run_tab } from "./run_tab.js";
import { summary_tab } from "./summary_tab.js";
import { surface_tab } from "./surface_tab.js";
import { Tabs } from "./tabs.js";
import { cut_set, box_of, surface_set } from "./triangles.js";
import { k_views } from "./camera.js";
import { View } from "./view.js";

const k_most_framed = 30000; // number of points, which is enough to frame any body
const k_view_titles = { iso: "Iso", front: "Front", back: "Back", side: "Side", top: "Top", bottom: "Bottom" };

export class ReportApp {
  constructor(report) {
    this.report = report;
    if (typeof report.surface !== "object" || report.surface === null) throw new ReportError("The report is damaged: its surface is missing.");
    if (!Array.isArray(report.origin) || report.origin.length !== 3 || !report.origin.every(Number.isFinite)) throw new ReportError("The report is damaged: its origin is not a position.");
    require_tables(report, ["patches", "cuts", "places", "gates", "histograms", "coverage"]);
    this.surface = null;
    this.cuts = [];
    this.view = null;
    this.painted = { surface: null, cut: null };
    this.state = new State(this.initial_values(read_hash()));
  }

  initial_values(hash) {
    const { report } = this;
    const index = (text, n) => (/^\d+$/.test(text ?? "") && Number(text) < n ? Number(text) : -1);
    const walls = report.patches.map((patch, k) => (patch.is_of_body ? k : -1)).filter((k) => k >= 0);
    const all = report.patches.map((_, k) => k);
    const wanted = hash.patches?.split(",").map((text) => index(text, all.length)).filter((k) => k >= 0);
    return {
      tab: hash.tab ?? (hash.place !== undefined ? "places" : hash.cut !== undefined ? "cuts" : "summary"),
      color: (report.surface?.fields ?? []).some((field) => field.name === hash.color) ? hash.color : "patch",
      range: range_of_text(hash.range),
      by_limits: hash.by_limits === "1",
      map: hash.map in k_maps ? hash.map : "viridis",
      edges: hash.edges !== "0",
      patches: new Set(hash.patches !== undefined ? wanted : walls.length ? walls : all),
      cut: index(hash.cut, report.cuts.length),
      cut_color: hash.cut_color ?? "kind",
      cut_edges: hash.cut_edges !== "0",
      around: ["show", "clip", "hide"].includes(hash.around) ? hash.around : "clip",
      place: index(hash.place, report.places.length),
      markers: hash.markers === "1",
      gate: hash.gate ?? "",
      view: hash.view in k_views ? hash.view : "iso",
      camera: hash.cam ?? "",
      options_filter: "",
    };
  }

  hash_entries() {
    const { values } = this.state;
    const usual = this.report.patches.map((p, k) => (p.is_of_body ? k : -1)).filter((k) => k >= 0);
    const shown = [...values.patches].sort((a, b) => a - b);
    return {
      tab: values.tab === "summary" && values.place < 0 && values.cut < 0 ? null : values.tab,
      color: values.color === "patch" ? null : values.color,
      range: values.range?.join(","),
      by_limits: values.by_limits ? 1 : null,
      map: values.map === "viridis" ? null : values.map,
      edges: values.edges ? null : 0,
      patches: shown.join() === usual.join() ? null : shown.join(",") || "none",
      cut: values.cut >= 0 ? values.cut : null,
      cut_color: values.cut >= 0 && values.cut_color !== "kind" ? values.cut_color : null,
      cut_edges: values.cut_edges ? null : 0,
      around: values.cut >= 0 && values.around !== "clip" ? values.around : null,
      place: values.place >= 0 ? values.place : null,
      markers: values.markers ? 1 : null,
      gate: values.gate,
      view: values.view === "iso" ? null : values.view,
      cam: values.camera,
    };
  }

  async start(root) {
    const { report, state } = this;
    document.title = `${report.title} \u2013 sterna report`;
    this.message = h("div.view_message", { role: "status", hidden: true });
    this.legends = h("div.legends");
    this.info = h("div.info", { "aria-live": "polite", hidden: true });
    this.view_box = h("div.view", null, h("div.view_top", null, this.toolbar(), this.info), this.legends, this.message);
    this.tabs = this.make_tabs();
    const panel = h("aside.panel", { "aria-label": "Report" }, this.tabs.bar, this.tabs.body);
    fill(root, h("div.report", null, banner(this), h("main.split", null, this.view_box, panel)));
    state.on(["tab"], ({ tab }) => this.tabs.show(tab));
    if (!this.tabs.has(state.get("tab"))) state.values.tab = "summary";
    try {
      await this.load().finally(() => this.tabs.show(state.get("tab"))); // tabs use ranges of fields; they are shown without arrays as well
      this.open_view();
    } catch (error) {
      this.say(sentence_of(error));
      if (!(error instanceof ReportError)) throw error;
    }
    state.on(null, () => write_hash(() => this.hash_entries()));
    window.addEventListener("hashchange", () => location.reload()); // a link to another location of the same page
  }

  async load() {
    this.say("Unpacking the arrays \u2026");
    const arrays = new Arrays(await read_blob());
    this.surface = read_surface(this.report, arrays);
    this.cuts = this.report.cuts.map((cut) => read_cut(cut, arrays));
    this.say("");
  }

  /** Shows a sentence over the picture; an empty sentence removes it. */
  say(text) {
    this.message.textContent = text;
    this.message.hidden = !text;
  }

  make_tabs() {
    const { report } = this;
    const list = [{ name: "summary", title: "Summary", make: () => summary_tab(this) }];
    list.push({ name: "surface", title: "Surface", make: () => surface_tab(this) });
    if (report.cuts.length) list.push({ name: "cuts", title: "Cuts", count: report.cuts.length, make: () => cuts_tab(this) });
    if (report.places.length) list.push({ name: "places", title: "Locations", count: report.places.length, make: () => places_tab(this) });
    if (report.histograms.length) list.push({ name: "histograms", title: "Histograms", make: () => histograms_tab(this) });
    if (report.coverage.length) list.push({ name: "coverage", title: "Coverage", make: () => coverage_tab(this) });
    if (report.run || report.manifest) list.push({ name: "run", title: "Run", make: () => run_tab(this) });
    return new Tabs(list, (name) => this.state.set({ tab: name }));
  }

  // ---- picture

  open_view() {
    const { state } = this;
    this.view = new View(this.view_box, this.report.origin, {
      hovered: (found) => this.show_info(found, false),
      clicked: (found) => this.show_info(found, true),
      marker_clicked: (k) => state.set({ place: this.marker_places[k], tab: "places" }),
      moved: () => state.set({ camera: this.camera_text() }),
      lost: (text) => this.say(text),
    });
    this.view.knows_fluid = this.report.kind === "volume" && this.report.verdict === "VALID";
    this.view.symmetry_normal = new Vector3(...(this.report.symmetry_normal ?? [0, 0, 0]));
    this.set = surface_set(this.surface, this.report.patches);
    this.view.set_surface(this.set);
    this.view.set_scene(box_of(this.set.positions).getBoundingSphere(new Sphere()));
    this.show_patches();
    this.paint_surface();
    this.show_cut();
    this.show_edges();
    this.show_markers();
    state.on(["patches"], ({ color, range }) => {
      this.show_patches();
      if (color !== "patch" && !range) this.paint_surface();
    });
    state.on(["color", "range", "map", "by_limits"], () => this.paint_surface());
    state.on(["cut"], ({ cut }) => {
      this.show_cut();
      if (cut >= 0) this.fly_to_cut(cut);
    });
    state.on(["cut_color", "map", "by_limits"], () => this.paint_cut());
    state.on(["around"], () => this.clip());
    state.on(["edges", "cut_edges"], () => this.show_edges());
    state.on(["markers", "gate", "place"], () => this.show_markers());
    state.on(["place"], ({ place }) => place >= 0 && this.fly_to_place(place));
    state.on(["place", "cut", "view"], () => this.show_info(null, true)); // the information about the clicked item is no longer relevant
    this.first_look();
  }

  /** Moves the camera as the link specifies: the stored camera, else the location, else the cut, else the named view. */
  first_look() {
    const { values } = this.state;
    this.view.look_along(values.view, this.visible_points(), false);
    const camera = values.camera.split(",").map(Number);
    if (camera.length === 8 && camera.every(Number.isFinite) && camera[3] > 0) this.set_camera(camera);
    else if (values.place >= 0) this.fly_to_place(values.place, false);
    else if (values.cut >= 0) this.view.fly_to_cut(this.cuts[values.cut], false);
  }

  set_camera([x, y, z, distance, qx, qy, qz, qw]) {
    const orientation = this.view.camera.orientation.clone().set(qx, qy, qz, qw).normalize();
    this.view.framed = null;
    this.view.camera.go({ target: this.view.local([x, y, z]), distance, orientation }, false);
  }

  camera_text() {
    const { target, distance, orientation } = this.view.camera;
    return [...this.view.absolute(target).map((x) => Number(x.toPrecision(9))), Number(distance.toPrecision(5)), ...orientation.toArray().map((q) => Number(q.toFixed(5)))].join(",");
  }

  visible_ranges() {
    return [...this.state.get("patches")].sort((a, b) => a - b).map((k) => this.set.ranges[k]);
  }

  /** Returns points that bound the visible objects: at most k_most_framed corners of visible triangles, or points of the body's size if nothing is visible. */
  visible_points() {
    const ranges = this.visible_ranges().filter(([from, to]) => to > from);
    const n = ranges.reduce((sum, [from, to]) => sum + 3 * (to - from), 0);
    const half = (this.report.length || 1) / 2;
    if (!n) return [-half, -half, -half, half, half, half];
    const step = Math.max(1, Math.ceil(n / k_most_framed)), points = [];
    const p = this.set.positions;
    for (const [from, to] of ranges) for (let corner = 3 * from; corner < 3 * to; corner += step) points.push(p[3 * corner], p[3 * corner + 1], p[3 * corner + 2]);
    return points;
  }

  show_patches() {
    this.view.show_ranges(this.visible_ranges());
    this.show_legends();
  }

  field(name) {
    return this.surface?.fields.find((field) => field.name === name) ?? null;
  }

  /** Returns the range of a field in the visible patches, because a farfield with edges of 100 m is not relevant for a wing; in all patches if the visible patches have no values. */
  shown_range(field) {
    return range_of(shown_values(field, this.surface.patch, this.state.get("patches")), field.is_log) ?? field_range(field);
  }

  /** Returns this range without outliers. */
  range_of_most(field) {
    return range_of_most(shown_values(field, this.surface.patch, this.state.get("patches")));
  }

  paint_surface() {
    const { color, range, map, by_limits } = this.state.values;
    const field = this.field(color);
    const painting = field ? paint_field(field, { range: range ?? this.shown_range(field), map, by_limits: by_limits && has_limits(field.limits) }) : paint_patches(this.surface, this.report.patches);
    this.view.surface.paint(painting.tones, painting.palette);
    this.painted.surface = painting;
    this.show_legends();
    this.view.request();
  }

  show_cut() {
    const k = this.state.get("cut");
    const cut = this.cuts[k];
    this.view.set_cut(cut ? cut_set(cut) : null, cut?.base ?? this.report.origin);
    this.painted.cut = null;
    if (cut) this.paint_cut();
    this.clip();
  }

  fly_to_cut(k) {
    this.state.set({ place: -1, camera: "" });
    this.view.fly_to_cut(this.cuts[k]);
  }

  cut_field(cut) {
    return cut.fields.find((field) => field.name === this.state.get("cut_color")) ?? null;
  }

  paint_cut() {
    const cut = this.cuts[this.state.get("cut")];
    if (!cut) return;
    const field = this.cut_field(cut);
    const { map, by_limits } = this.state.values;
    const painting = field ? paint_field(field, { range: null, map, by_limits: by_limits && has_limits(field.limits) }) : paint_kinds(cut);
    this.view.cut.paint(painting.tones, painting.palette);
    this.painted.cut = painting;
    this.show_legends();
    this.view.request();
  }

  clip() {
    const { cut, around } = this.state.values;
    const plane = this.cuts[cut];
    this.view.show_surface(!(plane && around === "hide"));
    this.view.set_clip(plane && around === "clip" ? plane : null);
    this.show_legends();
  }

  show_edges() {
    this.view.set_edges(this.state.get("edges"), this.state.get("cut_edges"));
  }

  show_legends() {
    const is_surface_shown = !(this.state.get("cut") >= 0 && this.state.get("around") === "hide");
    fill(this.legends, this.painted.cut?.legend, is_surface_shown ? (this.painted.surface?.legend ?? patches_legend(this.report.patches, this.state.get("patches"))) : null);
  }

  // ---- locations

  /** Returns the indices of the locations of the selected gate. */
  listed_places() {
    const gate = this.state.get("gate");
    return this.report.places.map((_, k) => k).filter((k) => !gate || this.report.places[k].gate === gate);
  }

  show_markers() {
    const { markers, place } = this.state.values;
    this.marker_places = markers ? this.listed_places() : [];
    this.view.set_markers(this.marker_places.map((k) => ({ at: this.report.places[k].at, colour: state_colour(this.report.places[k].state) })));
    const chosen = this.report.places[place];
    this.view.set_pin(chosen ? { at: chosen.at, title: place_title(chosen), text: place_text(chosen), colour: `rgb(${state_colour(chosen.state).join(" ")})` } : null);
  }

  fly_to_place(k, is_smooth = true) {
    this.state.set({ camera: "" });
    const ranges = this.set.ranges.filter((_, p) => this.report.patches[p].kind === "wall");
    this.view.fly_to_place(this.report.places[k].at, this.report.length, ranges, is_smooth);
  }

  /** Flies to a location without a gate. */
  fly_to_point(at, is_smooth = true) {
    this.state.set({ camera: "", place: -1 });
    const ranges = this.set.ranges.filter((_, p) => this.report.patches[p].kind === "wall");
    this.view.fly_to_place(at, this.report.length, ranges, is_smooth);
  }

  // ---- item under the pointer

  show_info(found, is_kept) {
    if (is_kept) this.kept = found;
    const shown = found ?? this.kept;
    this.picked = shown ?? null;
    this.info.hidden = !shown;
    if (!shown) return;
    fill(this.info, shown.layer === "surface" ? this.surface_info(shown) : this.cut_info(shown));
    this.info.classList.toggle("kept", shown === this.kept);
  }

  surface_info({ item, at }) {
    const patch = this.report.patches[this.surface.patch[item]];
    const chosen = this.field(this.state.get("color"));
    const fields = this.surface.fields.map((field) => h("span", { class: field === chosen ? "chosen" : null }, h("small", null, field.title), quantity_text(field.values[item], field.unit)));
    return [h("div", null, h("b", null, patch.name), h("small", null, ` ${patch.kind} \u00b7 triangle ${count_text(item)} \u00b7 at ${position_text(at)} m`)), h("div.info_values", null, fields)];
  }

  cut_info({ item, at }) {
    const cut = this.cuts[this.state.get("cut")];
    const fields = cut.fields.map((field) => h("span", null, h("small", null, field.title), quantity_text(field.values[item], field.unit)));
    return [h("div", null, h("b", null, k_kinds[cut.kind[item]]?.one ?? "cell"), h("small", null, ` cut \u201c${cut.name}\u201d \u00b7 at ${position_text(at)} m`)), h("div.info_values", null, fields)];
  }

  toolbar() {
    const look = (name) => {
      if (!this.view) return;
      this.state.set({ view: name, camera: "", place: -1 });
      this.view.look_along(name, this.visible_points());
    };
    const views = Object.entries(k_view_titles).map(([name, title]) => button(title, () => look(name), { title: `Look from: ${name}`, id: `view_${name}` }));
    const fit = button("Fit", () => this.view?.fit(this.visible_points()), { title: "Fit everything that is shown into the picture", id: "view_fit" });
    const edges = button("Edges", () => this.state.set({ edges: !this.state.get("edges") }), { title: "Edges of the mesh", pressed: this.state.get("edges"), id: "toggle_edges" });
    const markers = button("Locations", () => this.state.set({ markers: !this.state.get("markers") }), { title: "Show all worst locations as markers", pressed: this.state.get("markers"), id: "toggle_markers" });
    this.state.on(["edges", "markers"], (values) => {
      edges.setAttribute("aria-pressed", String(values.edges));
      markers.setAttribute("aria-pressed", String(values.markers));
    });
    const fields = this.report.surface?.fields ?? [];
    const colour = h("select", { id: "toolbar_color", title: "Colour of the surface", "aria-label": "Colour of the surface", onchange: () => this.state.set({ color: colour.value, range: null }) }, h("option", { value: "patch" }, "by patch"), fields.map((field) => h("option", { value: field.name }, field.title ?? field.name)));
    colour.value = this.state.get("color");
    this.state.on(["color"], (values) => (colour.value = values.color));
    const panel = button("Panel", () => {
      const is_shown = document.querySelector(".panel").toggleAttribute("hidden") === false;
      panel.setAttribute("aria-pressed", String(is_shown));
    }, { title: "Show or hide the tables on the right", pressed: true, id: "toggle_panel" });
    const save = button("PNG", () => this.save_picture(), { title: "Save the picture with legends", id: "save_picture" });
    return h("div.toolbar", { role: "toolbar", "aria-label": "View" }, h("div.group", null, views, fit), h("div.group", null, edges, this.report.places.length ? markers : null), fields.length ? h("div.group", null, colour) : null, h("div.group", null, save, panel));
  }

  async save_picture() {
    if (!this.view) return;
    const address = URL.createObjectURL(await this.view.picture(this.legends.children)); // browsers reject long data addresses
    h("a", { href: address, download: `${this.report.title.replace(/[^\w.-]+/g, "_")}.png` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
  }

  /** Returns the state of the page for tests; changes nothing. */
  test_state() {
    const { view, painted, state } = this;
    const values = { ...state.values, patches: [...state.values.patches] };
    if (!view) return { schema: this.report.schema, values, has_view: false, message: this.message.textContent };
    const scale = (painting) => (painting?.scale ? [painting.scale.low, painting.scale.high, painting.scale.is_log] : null);
    return {
      schema: this.report.schema,
      has_view: true,
      message: this.message.textContent,
      values,
      camera: { target: view.absolute(view.camera.target), distance: view.camera.distance, orientation: view.camera.orientation.toArray(), is_flying: Boolean(view.camera.flight || view.waiting) },
      drawn: { surface: view.surface.n_drawn(), cut: view.cut.n_drawn(), markers: view.marker_list.length, marker_at: view.marker_list.length ? view.on_screen(view.marker_list[0].at) : null },
      clip: [...view.surface.uniforms.clip.value],
      color_bar: { surface: scale(painted.surface), cut: scale(painted.cut) },
      picked: this.picked ? { layer: this.picked.layer, item: this.picked.item, patch: this.picked.layer === "surface" ? this.surface.patch[this.picked.item] : -1, at: this.picked.at, on_screen: view.on_screen(this.picked.at) } : null,
      pin: view.pin ? { at: view.pin.at, on_screen: view.on_screen(view.pin.at) } : null,
    };
  }
}

function range_of_text(text) {
  const list = (text ?? "").split(",").map(Number);
  return list.length === 2 && text && list.every(Number.isFinite) && list[0] < list[1] ? list : null;
}
