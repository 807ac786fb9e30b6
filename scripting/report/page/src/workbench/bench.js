// The workbench: the state of the runs, the picture, and the panels around it.
import { k_views } from "../camera.js";
import { k_maps, range_of } from "../colours.js";
import { button, fill, h } from "../dom.js";
import { ReportError, sentence_of } from "../errors.js";
import { paint_field, paint_patches, patches_legend, shown_values } from "../painting.js";
import { State } from "../state.js";
import { Tabs } from "../tabs.js";
import { cut_set } from "../triangles.js";
import { paint_kinds } from "../painting.js";
import { BenchView } from "./bench_view.js";
import { CasesPanel } from "./cases_panel.js";
import { compare_tab } from "./compare_tab.js";
import { cuts_tab } from "./cuts_tab.js";
import { inspect_tab } from "./inspect_tab.js";
import { log_tab } from "./log_tab.js";
import { mesh_tab } from "./mesh_tab.js";
import { object_tab } from "./object_tab.js";
import { parameters_panel } from "./parameters.js";
import { Picking } from "./picking.js";
import { script_tab } from "./script_tab.js";
import { get_cut, get_scene, get_state, post } from "./server.js";
import { status_line } from "./status.js";
import { tree_panel } from "./tree.js";

const k_retry = 1000; // ms until the next request if the program did not answer
const k_view_titles = { iso: "Iso", front: "Front", back: "Back", side: "Side", top: "Top", bottom: "Bottom" };
const k_view_keys = Object.keys(k_view_titles);
const k_error_colour = [204, 64, 52];

export class Bench {
  constructor() {
    // news: the latest state from the program; all other values are the user's.
    this.state = new State({ news: null, chosen: null, color: "patch", map: "viridis", edges: true, tab: "object", cut: null, around: "clip", cut_color: "kind", place: -1, is_before: false, is_split: false, is_in_cases: false, version: 0, shown: 0 });
    this.loading = new Map(); // key -> number of the scene that is loading
    this.loaded = new Map(); // key -> number of the scene in the picture
    this.lines = [];
    this.n_lines = 0;
    this.times = { news: 0, scene: 0, drawn: 0 }; // for tests: times at which the last news and scene arrived, and at which the last frame was drawn
    this.is_framed = false;
  }

  async start(root) {
    this.message = h("div.view_message", { role: "status", hidden: true });
    this.old_mark = h("div.old_mark", { role: "status", hidden: true });
    this.legends = h("div.legends");
    this.thin_note = h("div.thin_note", { hidden: true, title: "All triangles are drawn if the graphics card is fast enough, and in saved pictures" }, "thinned: drawing all triangles would take too long on this machine");
    this.info = h("div.info", { "aria-live": "polite", hidden: true });
    this.kept = h("div.info.kept", { hidden: true, id: "picked" });
    this.view_box = h("div.view", null, h("div.view_top", null, this.toolbar(), this.old_mark, this.kept, this.info), this.legends, this.message, this.thin_note, h("div.split_names", { "aria-hidden": "true" }, h("span", null, "before"), h("span", null, "now")));
    this.tabs = new Tabs(
      [
        { name: "object", title: "Object", make: () => object_tab(this) },
        { name: "mesh", title: "Mesh", make: () => mesh_tab(this) },
        { name: "inspect", title: "Inspect", make: () => inspect_tab(this) },
        { name: "cuts", title: "Cuts", make: () => cuts_tab(this) },
        { name: "compare", title: "Compare", make: () => compare_tab(this) },
        { name: "script", title: "Script", make: () => script_tab(this) },
        { name: "log", title: "Log", make: () => log_tab(this) },
      ],
      (name) => this.state.set({ tab: name }),
    );
    const left = h("aside.side", { "aria-label": "What the script made" }, parameters_panel(this), tree_panel(this));
    const right = h("aside.panel", { "aria-label": "Details" }, this.tabs.bar, this.tabs.body);
    fill(root, h("div.report", null, status_line(this), h("main.split", null, left, this.view_box, right)));
    this.state.on(["tab"], ({ tab }) => this.tabs.show(tab));
    this.tabs.show("object");
    this.view = new BenchView(this.view_box, {
      hovered: (found) => this.picking.show(found, false),
      clicked: (found) => this.picking.show(found, true),
      marker_clicked: (k) => this.fly_to_marker(k),
      lost: (text) => this.say(text),
      drawn: () => {
        this.picking?.draw();
        this.times.drawn = performance.now();
        this.thin_note.hidden = !this.view || this.view.level === 0 || this.view.pace.is_moving;
      },
    });
    this.picking = new Picking(this);
    this.view.set_edges(true, true);
    this.state.on(["color", "map", "is_before"], () => this.paint());
    this.state.on(["edges"], ({ edges }) => this.view.set_edges(edges, true));
    this.state.on(["is_split"], ({ is_split }) => {
      if (is_split) this.state.set({ is_before: false });
      this.view.split(is_split);
      this.paint();
      this.clip();
    });
    this.state.on(["cut", "cut_color", "map"], () => this.paint_cut());
    this.state.on(["cut", "around"], () => this.clip());
    this.state.on(["chosen"], ({ chosen }) => {
      this.view.choose(chosen);
      this.paint();
    });
    document.addEventListener("keydown", (event) => this.key(event));
    const news = await get_state(0, 0);
    if (news.has_cases) await this.open_cases();
    await this.take_news(news);
    this.listen(); // continues while the page exists
  }

  /** Shows the cases first if the page is about a series. */
  async open_cases() {
    this.cases = new CasesPanel(this);
    this.view_box.append(this.cases.element);
    this.state.set({ is_in_cases: true });
    await this.cases.load();
  }

  /** Waits until the news fulfil a condition and all visible objects are in the picture. \throws ReportError after `patience` ms */
  async is_shown_as(is_so, patience) {
    const is_there = () => is_so(this.state.get("news")) && this.objects().every((object) => !this.is_shown(object) || !object.scene || this.loaded.get(object.key) === object.scene);
    for (const end = performance.now() + patience; performance.now() < end; await new Promise((resolve) => setTimeout(resolve, 30))) if (is_there()) return;
    throw new ReportError("The picture was not complete within the time limit.");
  }

  /** Registers a listener for changes of these names while the tab is visible; a hidden tab is updated when it is shown again. */
  on_in_tab(tab, names, call) {
    let has_missed = false;
    this.state.on(names, (values) => {
      has_missed = values.tab !== tab;
      if (!has_missed) call(values);
    });
    this.state.on(["tab"], (values) => {
      if (values.tab !== tab || !has_missed) return;
      has_missed = false;
      call(values);
    });
  }

  // ---- News of the program

  async listen() {
    for (;;) {
      try {
        const news = await get_state(this.state.get("version"), this.n_lines);
        this.say("");
        if (news.is_over) return this.say("The workbench has ended: start sterna view again.");
        await this.take_news(news);
      } catch (error) {
        this.say(`The program does not respond: ${error instanceof ReportError ? error.message : "has it ended?"}`);
        await new Promise((resolve) => setTimeout(resolve, k_retry));
      }
    }
  }

  async take_news(news) {
    this.times.news = performance.now();
    this.n_lines = news.n_lines;
    this.lines.push(...news.lines);
    if (this.lines.length > 1000) this.lines.splice(0, this.lines.length - 1000);
    document.title = `${news.file} \u2013 sterna view`;
    const is_gone = (key) => !news.objects.some((object) => object.key === key);
    for (const key of [...this.loading.keys()].filter(is_gone)) this.loading.delete(key);
    for (const key of [...this.loaded.keys()].filter(is_gone)) this.forget(key);
    this.state.set({ news, version: news.version });
    this.show_old();
    this.show_markers();
    this.load_scenes();
  }

  /** Loads the scenes of visible objects that are newer than those in the picture. */
  load_scenes() {
    for (const object of this.objects()) {
      if (!object.scene || this.loaded.get(object.key) === object.scene || this.loading.get(object.key) === object.scene || !this.is_shown(object)) continue;
      this.loading.set(object.key, object.scene);
      this.load(object.key, object.scene, object.scene_run);
    }
  }

  async load(key, number, run) {
    try {
      const scene = await get_scene(number);
      if (this.loading.get(key) !== number) return; // a newer scene is loading
      this.loaded.set(key, number);
      this.view.take(key, { ...scene, run });
      this.times.scene = performance.now();
      this.take_scene();
    } catch (error) {
      if (!(error instanceof ReportError)) throw error; // the scene no longer exists; news of the next scene will follow
    } finally {
      if (this.loading.get(key) === number) this.loading.delete(key);
    }
  }

  /** Updates the page after a scene has arrived. */
  take_scene() {
    const shown = this.objects().filter((object) => this.is_shown(object) && this.loaded.has(object.key));
    if (!shown.some((object) => object.key === this.state.get("chosen")) && shown.length) this.state.set({ chosen: shown[shown.length - 1].key });
    this.refresh_visible();
    if (!this.is_framed && shown.length) {
      this.is_framed = true;
      this.view.look_along("iso", this.view.visible_points(), false);
    }
    this.state.set({ shown: this.state.get("shown") + 1 });
    this.paint();
    this.clip();
  }

  forget(key) {
    this.loaded.delete(key);
    this.view.drop(key);
    if (this.state.get("chosen") === key) this.state.set({ chosen: null });
  }

  // ---- Objects

  objects() {
    return this.state.get("news")?.objects ?? [];
  }

  object(key) {
    return this.objects().find((object) => object.key === key) ?? null;
  }

  /** Returns whether an object is visible: the selection of the user, otherwise that of the program. */
  is_shown(object) {
    return this.choices?.get(object.key) ?? object.is_shown;
  }

  show(key, is_shown) {
    this.choices ??= new Map();
    this.choices.set(key, is_shown);
    post("show", { key, is_shown }).catch((error) => this.say_for_a_while(sentence_of(error)));
    this.refresh_visible();
    this.load_scenes();
    if (is_shown && this.loaded.has(key)) this.state.set({ chosen: key });
    this.state.set({ shown: this.state.get("shown") + 1 });
    this.paint();
  }

  isolate(key) {
    for (const object of this.objects()) if (this.is_shown(object) !== (object.key === key)) this.show(object.key, object.key === key);
  }

  refresh_visible() {
    for (const object of this.objects()) {
      const shown = this.view.objects.get(object.key);
      if (!shown) continue;
      shown.is_visible = this.is_shown(object);
      shown.refresh();
    }
    this.view.request();
  }

  /** Shows or hides patches of an object by name. */
  show_patches(key, names, is_shown) {
    const shown = this.view.objects.get(key);
    if (!shown) return;
    for (const name of names) is_shown ? shown.hidden.delete(name) : shown.hidden.add(name);
    shown.refresh();
    this.state.set({ shown: this.state.get("shown") + 1 });
    this.paint();
    this.view.request();
  }

  /** Returns the object of the panels with its scene, or null. */
  chosen() {
    return this.view?.objects.get(this.state.get("chosen")) ?? null;
  }

  // ---- Colours

  /** Returns the fields of the visible objects by name. */
  fields() {
    const fields = new Map();
    for (const shown of this.view?.visible() ?? []) for (const field of shown.drawn.scene.surface.fields) if (!fields.has(field.name)) fields.set(field.name, field);
    return [...fields.values()];
  }

  paint() {
    if (!this.view) return;
    const { color, map } = this.state.values;
    const visible = this.view.visible();
    const field_in = (shown) => shown.drawn.scene.surface.fields.find((field) => field.name === color) ?? null;
    // One range for all objects, so that their colours can be compared.
    let range = null;
    for (const shown of visible) {
      const field = field_in(shown);
      const own = field && range_of(shown_values(field, shown.drawn.scene.surface.patch, shown.shown_patches()), field.is_log);
      if (own) range = range ? [Math.min(range[0], own[0]), Math.max(range[1], own[1])] : own;
    }
    let legend = null;
    for (const shown of visible) {
      const field = field_in(shown);
      const painting = field ? paint_field(field, { range, map, by_limits: false }) : paint_patches(shown.drawn.scene.surface, shown.drawn.scene.patches);
      shown.layer.paint(painting.tones, painting.palette);
      legend ??= painting.legend;
      if (shown.before.set) this.paint_before(shown, color, range, map);
    }
    const chosen = this.chosen();
    this.surface_legend = legend ?? (chosen?.drawn ? patches_legend(chosen.drawn.scene.patches, chosen.shown_patches()) : null);
    fill(this.legends, this.cut_legend, this.surface_legend);
    this.view.request();
  }

  /** Colours the previous run beside this run by the same quantity, on the same scale. */
  paint_before(shown, color, range, map) {
    const { scene } = shown.previous;
    const field = scene.surface.fields.find((entry) => entry.name === color);
    const painting = field ? paint_field(field, { range, map, by_limits: false }) : paint_patches(scene.surface, scene.patches);
    shown.before.paint(painting.tones, painting.palette);
  }

  // ---- Cuts

  async cut_at(key, plane) {
    try {
      const cut = await get_cut(key, plane);
      this.state.set({ cut });
      return true;
    } catch (error) {
      if (!(error instanceof ReportError)) throw error;
      this.say_for_a_while(error.message);
      return false;
    }
  }

  paint_cut() {
    const { cut, cut_color, map } = this.state.values;
    if (this.drawn_cut !== cut) this.view.set_cut(cut ? cut_set(cut) : null, cut?.base);
    this.drawn_cut = cut;
    this.cut_legend = null;
    if (cut) {
      const field = cut.fields.find((entry) => entry.name === cut_color);
      const painting = field ? paint_field(field, { range: null, map, by_limits: false }) : paint_kinds(cut);
      this.view.cut.paint(painting.tones, painting.palette);
      this.cut_legend = painting.legend;
    }
    fill(this.legends, this.cut_legend, this.surface_legend);
    this.view.request();
  }

  clip() {
    const { cut, around } = this.state.values;
    this.view.set_clip(cut && around === "clip" ? cut : null);
    this.view.hide_surfaces(Boolean(cut && around === "hide"));
  }

  // ---- Locations

  /** Returns the locations of the selected mesh, or of errors. */
  places() {
    const problems = this.state.get("news")?.problems ?? [];
    const of_errors = problems.flatMap((problem) => problem.places.map((place) => ({ at: place.at, title: "error", text: place.what, colour: k_error_colour })));
    return of_errors;
  }

  show_markers() {
    this.marker_places = this.places();
    this.view.set_markers(this.marker_places.map(({ at, colour }) => ({ at, colour })));
  }

  fly_to_marker(k) {
    const place = this.marker_places[k];
    if (place) this.fly_to(place);
  }

  /** {at, title, text, colour} */
  fly_to(place) {
    const chosen = this.chosen();
    this.view.set_pin({ ...place, colour: `rgb(${place.colour.join(" ")})` });
    if (chosen?.set) this.view.fly_to_place(place.at, chosen.scene.length, chosen.ranges());
  }

  // ---- Messages

  say(text) {
    this.message.textContent = text;
    this.message.hidden = !text;
  }

  say_for_a_while(text) {
    this.say(text);
    clearTimeout(this.silence);
    this.silence = setTimeout(() => this.say(""), 6000);
  }

  show_old() {
    const { news } = this.state.values;
    const problem = news.problems[0];
    const is_broken = news.run.status === "failed" && problem;
    const old = this.objects().filter((object) => object.is_old && this.is_shown(object) && object.scene);
    this.old_mark.hidden = !is_broken && !old.length;
    this.old_mark.classList.toggle("broken", Boolean(is_broken));
    if (is_broken) {
      const more = news.problems.length > 1 ? ` (and ${news.problems.length - 1} more)` : "";
      fill(this.old_mark, old.length ? h("b", null, "Old picture. ") : null, h("span.problem_text", null, `${problem.text}${more}`), button("Show", () => this.state.set({ tab: "script" }), { kind: ".small", id: "show_problem" }));
    } else if (old.length) fill(this.old_mark, h("b", null, "Old: "), `${old.map((object) => object.key).join(", ")} \u2013 of an earlier run`);
  }

  toolbar() {
    const look = (name) => this.view?.look_along(name, this.view.visible_points());
    const views = Object.entries(k_view_titles).map(([name, title], k) => button(title, () => look(name), { title: `Look from: ${name} (key ${k + 1})`, id: `view_${name}` }));
    const fit = button("Fit", () => this.view?.fit(this.view.visible_points()), { title: "Fit everything that is shown into the picture (key F)", id: "view_fit" });
    const edges = button("Edges", () => this.state.set({ edges: !this.state.get("edges") }), { title: "Edges (key E)", pressed: true, id: "toggle_edges" });
    this.state.on(["edges"], (values) => edges.setAttribute("aria-pressed", String(values.edges)));
    const colour = h("select", { id: "color", title: "Colour", "aria-label": "Colour", onchange: () => this.state.set({ color: colour.value }) });
    const map = h("select", { id: "map", title: "Colour map", "aria-label": "Colour map", onchange: () => this.state.set({ map: map.value }) }, Object.keys(k_maps).map((name) => h("option", { value: name }, name)));
    this.state.on(["shown"], () => {
      const fields = this.fields();
      fill(colour, h("option", { value: "patch" }, "by patch"), fields.map((field) => h("option", { value: field.name }, field.unit ? `${field.title} [${field.unit}]` : field.title)));
      colour.value = fields.some((field) => field.name === this.state.get("color")) ? this.state.get("color") : "patch";
    });
    const save = button("PNG", () => this.save_picture(), { title: "Save the picture with legends", id: "save_picture" });
    return h("div.toolbar", { role: "toolbar", "aria-label": "View" }, h("div.group", null, views, fit), h("div.group", null, edges), h("div.group", null, colour), h("div.group", null, map), h("div.group", null, save));
  }

  async save_picture() {
    const address = URL.createObjectURL(await this.view.picture(this.legends.children));
    h("a", { href: address, download: `${(this.state.get("news")?.file ?? "sterna").replace(/[^\w.-]+/g, "_")}.png` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
  }

  mesh_now() {
    post("run", { mode: "mesh" }).catch((error) => this.say_for_a_while(sentence_of(error)));
  }

  key(event) {
    if (event.target.closest?.("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey || !this.view) return;
    const k = Number(event.key) - 1;
    if (k_view_keys[k] in k_views) this.view.look_along(k_view_keys[k], this.view.visible_points());
    else if (event.key === "f") this.view.fit(this.view.visible_points());
    else if (event.key === "e") this.state.set({ edges: !this.state.get("edges") });
    else if (event.key === "m") this.mesh_now();
    else if (event.key === "h") this.picking.hide_patch();
    else if (event.key === "a") this.show_all_patches();
    else if (event.key === "s") this.state.set({ is_split: !this.state.get("is_split") });
    else if (event.key === "c" && this.cases) this.cases.show(!this.state.get("is_in_cases"));
    else if (event.key === "b") this.state.set({ is_before: !this.state.get("is_before") });
    else if (event.key === "Escape") this.picking.clear();
    else return;
    event.preventDefault();
  }

  show_all_patches() {
    for (const shown of this.view.objects.values()) shown.drawn && this.show_patches(shown.key, [...shown.hidden], true);
  }

  /** Returns the state of the page for tests; changes nothing. */
  test_state() {
    const { news, ...values } = this.state.values;
    const shown = [...(this.view?.objects.values() ?? [])].map((object) => ({
      key: object.key,
      kind: object.scene?.kind,
      is_quick: object.scene?.is_quick,
      is_visible: object.is_visible,
      triangles: object.drawn?.set.n ?? 0,
      drawn: object.layer.n_drawn(),
      span: object.drawn ? object.drawn.set.boxes.reduce((most, box) => Math.max(most, box.max.y - box.min.y), 0) : 0,
      box: object.drawn ? extent_of(object.drawn.set.positions, object.drawn.scene.origin) : null,
      hidden: [...object.hidden],
    }));
    return {
      ...values,
      cut: values.cut ? { n: values.cut.n, name: values.cut.name } : null,
      run: news?.run,
      problems: news?.problems,
      values: news?.values,
      parameters: news?.parameters,
      objects: news?.objects,
      shown,
      n_lines: this.n_lines,
      times: { ...this.times },
      message: this.message?.hidden ? "" : this.message?.textContent,
      old: this.old_mark?.hidden ? "" : this.old_mark?.textContent,
      picks: this.picking?.picks.map(({ key, kind, patch, at, picture }) => ({ key, kind, patch, at, picture })),
      pin: this.view?.pin ? { at: this.view.pin.at } : null,
      cases: this.cases ? { n: this.cases.cases.length, pictures: this.cases.pictures.size, current: this.cases.current() } : null,
      before: shown_before(this.view),
      pace: this.view ? { level: this.view.level, is_moving: this.view.pace.is_moving, costs: [...this.view.pace.costs], thin: [...this.view.objects.values()].reduce((sum, object) => sum + (object.drawn?.set.thin?.n ?? 0), 0) } : null,
      is_flying: Boolean(this.view?.camera.flight),
      camera: this.view ? { distance: this.view.camera.distance, orientation: this.view.camera.orientation.toArray() } : null,
    };
  }
}

/** Returns the triangles of the previous run that are beside this run, by object. */
function shown_before(view) {
  return [...(view?.objects.values() ?? [])].filter((object) => object.before.set).map((object) => ({ key: object.key, drawn: object.before.ranges.reduce((sum, [from, to]) => sum + to - from, 0) }));
}

function extent_of(positions, origin) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < positions.length; ++k) {
    low[k % 3] = Math.min(low[k % 3], positions[k]);
    high[k % 3] = Math.max(high[k % 3], positions[k]);
  }
  return [low.map((x, c) => x + origin[c]), high.map((x, c) => x + origin[c])];
}
