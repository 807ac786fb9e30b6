// The picture of several objects, each with its own triangles and origin. The selected object is the surface of the view.
import { Box3, Sphere, Vector3 } from "three";
import { surface_set, thin_set } from "../triangles.js";
import { Layer, View } from "../view.js";
import { k_levels, Pace } from "./pace.js";

const k_thin_from = 200000; // number of triangles from which a surface has a thin set for movements
const k_most_framed = 30000; // number of points, which is enough to frame any body

/** An object in the picture. */
class Shown {
  constructor(view, key) {
    this.view = view;
    this.key = key;
    this.layer = new Layer(view.scene);
    this.scene = null;
    this.set = null;
    this.is_visible = true;
    this.hidden = new Set(); // names of the hidden patches
    this.previous = null; // {scene, set} of the previous run
    this.before = new Layer(view.scene); // layer of the previous run while both are side by side
    this.last = null; // the previous run while sketches are shown, for the next comparison
  }

  take(scene) {
    if (this.scene?.is_quick) this.set.dispose(); // sketches are not compared
    else if (this.scene?.run === scene.run) this.set?.dispose();
    else if (this.scene && !scene.is_quick) this.keep({ scene: this.scene, set: this.set });
    else if (this.scene) this.last = { scene: this.scene, set: this.set };
    if (!scene.is_quick && this.last) {
      this.keep(this.last);
      this.last = null;
    }
    // A farfield or a tunnel would hide the body. The user can show it in the tree.
    if (!this.scene && (scene.kind === "volume" || scene.kind === "surface") && scene.patches.some((patch) => patch.is_of_body))
      for (const patch of scene.patches) if (!patch.is_of_body) this.hidden.add(patch.name);
    this.scene = scene;
    this.set = surface_set(scene.surface, scene.patches);
    if (scene.surface.n >= k_thin_from) this.set.thin = thin_set(scene.surface, scene.patches, this.set);
    this.show({ scene: this.scene, set: this.set });
  }

  keep(previous) {
    if (this.previous && this.previous.set !== previous.set) this.previous.set.dispose();
    this.previous = previous;
    this.show_before();
  }

  /** Gives the previous run its own layer while both are side by side. */
  show_before() {
    const { previous } = this.view.is_split ? this : { previous: null };
    if (this.before.set === (previous?.set ?? null)) return;
    this.before.set = null; // not disposed, because it is kept here
    this.before.show(previous?.set ?? null, previous ? new Vector3(...previous.scene.origin).sub(this.view.origin) : null);
    if (!previous) return;
    this.before.thin = previous.set.thin ?? null;
    this.before.uniforms.outward.value = previous.set.outward;
    this.refresh();
  }

  /** Shows one run: the current or the previous run. */
  show({ scene, set }) {
    this.drawn = { scene, set };
    this.layer.set = null; // the layer would dispose of the run that it showed; the previous run is kept here
    this.layer.show(set, new Vector3(...scene.origin).sub(this.view.origin));
    this.layer.thin = set.thin ?? null;
    this.layer.uniforms.outward.value = set.outward;
    this.refresh();
  }

  /** Returns the ranges of the visible patches. */
  ranges(set = this.drawn.set, scene = this.drawn.scene) {
    return set.ranges.filter((_, p) => !this.hidden.has(scene.patches[p].name));
  }

  shown_patches(scene = this.drawn.scene) {
    return new Set(scene.patches.map((_, p) => p).filter((p) => !this.hidden.has(scene.patches[p].name)));
  }

  refresh() {
    if (!this.drawn) return;
    const { thin } = this.drawn.set;
    this.layer.show_ranges(this.is_visible ? this.ranges() : [], this.is_visible && thin ? this.ranges(thin) : []);
    if (!this.before.set) return;
    const { set, scene } = this.previous;
    this.before.show_ranges(this.is_visible ? this.ranges(set, scene) : [], this.is_visible && set.thin ? this.ranges(set.thin, scene) : []);
  }

  place() {
    if (this.drawn && this.layer.mesh) this.layer.mesh.position.copy(new Vector3(...this.drawn.scene.origin).sub(this.view.origin));
    if (this.before.mesh) this.before.mesh.position.copy(new Vector3(...this.previous.scene.origin).sub(this.view.origin));
  }

  leave() {
    for (const { mesh } of [this.layer, this.before]) if (mesh) this.view.scene.remove(mesh);
    this.set?.dispose();
    this.previous?.set.dispose();
    this.last?.set.dispose();
  }
}

export class BenchView extends View {
  constructor(container, handlers) {
    super(container, [0, 0, 0], handlers);
    this.objects = new Map();
    this.nothing = this.surface; // a layer without triangles
    this.chosen = null;
    this.is_split = false; // the previous run is on the left, this run on the right
    this.has_hidden_surfaces = false;
    this.has_origin = false;
    this.pace = new Pace(this.renderer.getContext(), () => this.request());
    this.full_ratio = this.renderer.getPixelRatio();
    this.restyle(); // the first call was before the objects existed
  }

  layers() {
    return [...(this.objects?.values() ?? [])].flatMap((object) => (object.before.set ? [object.layer, object.before] : [object.layer]));
  }

  /** Shows the previous run beside this run, from one camera. */
  split(is_split) {
    this.is_split = is_split;
    this.camera.n_pictures = is_split ? 2 : 1;
    this.container.classList.toggle("split_view", is_split);
    for (const object of this.objects.values()) object.show_before();
    this.style_layers();
    this.resize();
  }

  /** Hides or shows all surfaces; without them only the cut is visible. */
  hide_surfaces(are_hidden) {
    this.has_hidden_surfaces = are_hidden;
    this.show_side(1);
    this.request();
  }

  /** Shows the objects that belong to the picture of the previous run (0) or of this run (1). */
  show_side(side) {
    for (const object of this.objects.values()) {
      if (object.layer.mesh) object.layer.mesh.visible = side === 1 && !this.has_hidden_surfaces;
      if (object.before.mesh) object.before.mesh.visible = side === 0 && !this.has_hidden_surfaces;
    }
    if (this.cut.mesh) this.cut.mesh.visible = side === 1;
    if (this.markers) this.markers.visible = side === 1;
  }

  take(key, scene) {
    if (!this.has_origin) {
      this.origin.set(...scene.origin);
      this.has_origin = true;
    }
    if (!this.objects.has(key)) this.objects.set(key, new Shown(this, key));
    const object = this.objects.get(key);
    object.take(scene);
    if (this.chosen === key) this.choose(key);
    if (scene.is_quick) this.moves();
    this.style_layers();
    this.measure_scene();
    this.request();
    return object;
  }

  drop(key) {
    this.objects.get(key)?.leave();
    this.objects.delete(key);
    if (this.chosen === key) this.choose(null);
    this.measure_scene();
    this.request();
  }

  /** Selects the object of locations, cuts and camera flights. Its origin becomes the origin of the picture, for accuracy. */
  choose(key) {
    const object = this.objects.get(key);
    this.chosen = object ? key : null;
    this.surface = object?.layer ?? this.nothing;
    if (!object) return;
    const origin = new Vector3(...object.drawn.scene.origin);
    const shift = origin.clone().sub(this.origin);
    if (shift.length() > 0) {
      this.camera.target.sub(shift);
      if (this.framed) this.framed = this.framed.map((x, k) => x - shift.getComponent(k % 3));
      this.origin.copy(origin);
      for (const other of this.objects.values()) other.place();
      if (this.marker_list.length) this.set_markers(this.marker_list);
    }
    this.knows_fluid = object.scene.kind === "volume" && object.scene.verdict === "VALID";
    this.symmetry_normal.set(...(object.scene.symmetry_normal ?? [0, 0, 0]));
  }

  visible() {
    return [...this.objects.values()].filter((object) => object.is_visible && object.drawn);
  }

  /** Returns points (relative to the origin) that bound the visible objects. */
  visible_points() {
    const points = [];
    const objects = this.visible();
    const n = objects.reduce((sum, object) => sum + object.ranges().reduce((s, [from, to]) => s + 3 * (to - from), 0), 0);
    const step = Math.max(1, Math.ceil(n / k_most_framed));
    for (const object of objects) {
      const p = object.drawn.set.positions, { x, y, z } = object.layer.mesh.position;
      for (const [from, to] of object.ranges()) for (let corner = 3 * from; corner < 3 * to; corner += step) points.push(p[3 * corner] + x, p[3 * corner + 1] + y, p[3 * corner + 2] + z);
    }
    return points.length ? points : [-1, -1, -1, 1, 1, 1];
  }

  measure_scene() {
    const sphere = new Sphere(new Vector3(), -1);
    for (const object of this.objects.values()) {
      if (!object.drawn) continue;
      const own = object.drawn.set.boxes.reduce((all, box) => all.union(box), new Box3()).getBoundingSphere(new Sphere());
      own.center.add(object.layer.mesh.position);
      sphere.isEmpty() ? sphere.copy(own) : sphere.union(own);
    }
    if (!sphere.isEmpty()) this.set_scene(sphere);
  }

  style_layers() {
    for (const layer of this.layers()) {
      layer.uniforms.edge_colour.value = this.cut.uniforms.edge_colour.value;
      layer.uniforms.edge_strength.value = this.has_edges ? 0.5 : 0;
    }
  }

  restyle() {
    super.restyle();
    this.style_layers();
  }

  set_edges(surface, cut) {
    this.has_edges = surface;
    super.set_edges(surface, cut);
    this.style_layers();
  }

  set_clip(plane) {
    const clip = (layer, { scene }) => {
      layer.uniforms.clip.value = plane ? [...plane.normal, new Vector3(...plane.normal).dot(new Vector3(...plane.origin).sub(new Vector3(...scene.origin)))] : [0, 0, 0, 1];
    };
    for (const object of this.objects.values()) {
      clip(object.layer, object.drawn ?? object);
      if (object.previous) clip(object.before, object.previous);
    }
    this.request();
  }

  set_cut(set, base) {
    this.cut.show(set, base ? this.local(base) : new Vector3());
    this.request();
  }

  draw() {
    this.camera.apply();
    for (const layer of [...this.layers(), this.cut]) {
      layer.uniforms.near.value = this.lens.near;
      layer.uniforms.far.value = this.lens.far;
    }
    const level = this.use_level();
    if (this.is_split) this.render_both();
    else this.renderer.render(this.scene, this.lens);
    this.pace?.measure(level);
    this.draw_pin();
    this.draw_axes();
    this.draw_scale_bar();
    this.handlers.drawn?.();
  }

  render_both() {
    const { renderer } = this;
    const width = this.container.clientWidth / 2, height = this.container.clientHeight;
    renderer.setScissorTest(true);
    for (const side of [0, 1]) {
      this.show_side(side);
      renderer.setViewport(side * width, 0, width, height);
      renderer.setScissor(side * width, 0, width, height);
      renderer.render(this.scene, this.lens);
    }
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, 2 * width, height);
  }

  moves() {
    this.pace?.move();
  }

  /** Sets the drawing level of the frame and returns it. */
  use_level() {
    if (!this.pace) return 0;
    const layers = [...this.layers(), this.cut];
    const level = this.pace.level(layers.reduce((sum, layer) => sum + layer.n_drawn(), 0), layers.reduce((sum, layer) => sum + layer.n_drawn_thin(), 0));
    this.level = level;
    for (const layer of this.layers()) layer.use_thin(k_levels[level].is_thin);
    const ratio = this.full_ratio * k_levels[level].share;
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    return level;
  }

  /** Returns the drawing, `width` pixels wide, as the address of a picture. */
  async thumbnail(width) {
    this.pace.rest();
    this.draw(); // in the same task, because the canvas is empty afterwards
    const small = document.createElement("canvas");
    small.width = width;
    small.height = Math.round((width * this.canvas.height) / this.canvas.width);
    small.getContext("2d").drawImage(this.canvas, 0, 0, small.width, small.height);
    return small.toDataURL("image/png");
  }

  picture(elements) {
    this.pace.rest();
    return super.picture(elements);
  }

  pixels() {
    this.pace.rest();
    return super.pixels();
  }

  /** Returns {key, item, at, point, picture} of an object, {layer: "cut", item, at, picture}, or null. */
  pick(x, y) {
    const objects = [...(this.objects?.values() ?? [])];
    const side = this.is_split && x < this.container.clientWidth / 2 ? 0 : 1;
    if (this.is_split) this.show_side(side);
    const found = this.hit([...objects.map((object) => (side === 0 ? object.before : object.layer)), this.cut], x, y);
    if (!found) return null;
    const key = objects[found.index]?.key ?? null;
    return { layer: key === null ? "cut" : "surface", key, triangle: found.triangle, item: found.item, at: found.at, point: found.point, picture: this.is_split ? side : 0 };
  }
}
