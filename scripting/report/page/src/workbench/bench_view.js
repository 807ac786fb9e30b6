// The picture of several objects, each with its own triangles and origin; what is chosen among them is the view's surface.
import { Sphere, Vector3 } from "three";
import { box_of, surface_set } from "../triangles.js";
import { Layer, View } from "../view.js";

const k_most_framed = 30000; // points: enough to frame any body

/** An object in the picture. */
class Shown {
  constructor(view, key) {
    this.view = view;
    this.key = key;
    this.layer = new Layer(view.scene);
    this.scene = null;
    this.set = null;
    this.is_visible = true;
    this.hidden = new Set(); // names of patches
    this.previous = null; // {scene, set} of the run before
    this.last = null; // the same while sketches are shown: what will be the one before
  }

  take(scene) {
    if (this.scene?.is_quick) this.set.dispose(); // a sketch is no run that one compares with
    else if (this.scene && !scene.is_quick) this.keep({ scene: this.scene, set: this.set });
    else if (this.scene) this.last = { scene: this.scene, set: this.set };
    if (!scene.is_quick && this.last) {
      this.keep(this.last);
      this.last = null;
    }
    this.scene = scene;
    this.set = surface_set(scene.surface, scene.patches);
    this.show({ scene: this.scene, set: this.set });
  }

  keep(previous) {
    if (this.previous && this.previous.set !== previous.set) this.previous.set.dispose();
    this.previous = previous;
  }

  /** Shows that one: the current, or the one before. */
  show({ scene, set }) {
    this.drawn = { scene, set };
    this.layer.set = null; // the layer would throw away what it showed; the one before is kept here
    this.layer.show(set, new Vector3(...scene.origin).sub(this.view.origin));
    this.layer.uniforms.outward.value = set.outward;
    this.refresh();
  }

  /** Ranges of the patches that are shown. */
  ranges() {
    const { scene, set } = this.drawn;
    return set.ranges.filter((_, p) => !this.hidden.has(scene.patches[p].name));
  }

  shown_patches() {
    const { scene } = this.drawn;
    return new Set(scene.patches.map((_, p) => p).filter((p) => !this.hidden.has(scene.patches[p].name)));
  }

  refresh() {
    if (!this.drawn) return;
    this.layer.show_ranges(this.is_visible ? this.ranges() : []);
  }

  place() {
    if (this.drawn && this.layer.mesh) this.layer.mesh.position.copy(new Vector3(...this.drawn.scene.origin).sub(this.view.origin));
  }

  leave() {
    if (this.layer.mesh) this.view.scene.remove(this.layer.mesh);
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
    this.has_origin = false;
    this.restyle(); // the first time was before there were objects
  }

  layers() {
    return [...(this.objects?.values() ?? [])].map((object) => object.layer);
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

  /** The object that places, cuts and the camera's flights are about; its origin becomes the picture's, for accuracy. */
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

  /** Points (relative to the origin) that bound what is shown. */
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
      const own = box_of(object.drawn.set.positions).getBoundingSphere(new Sphere());
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
    for (const object of this.objects.values()) {
      const clip = object.layer.uniforms.clip;
      if (!plane) clip.value = [0, 0, 0, 1];
      else clip.value = [...plane.normal, new Vector3(...plane.normal).dot(new Vector3(...plane.origin).sub(new Vector3(...(object.drawn ?? object).scene.origin)))];
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
    this.renderer.render(this.scene, this.lens);
    this.draw_pin();
    this.draw_axes();
    this.draw_scale_bar();
    this.handlers.drawn?.();
  }

  /** {key, item, at, point} of an object, {layer: "cut", item, at}, or null. */
  pick(x, y) {
    const objects = [...(this.objects?.values() ?? [])];
    const found = this.hit([...objects.map((object) => object.layer), this.cut], x, y);
    if (!found) return null;
    const key = objects[found.index]?.key ?? null;
    return { layer: key === null ? "cut" : "surface", key, triangle: found.triangle, item: found.item, at: found.at, point: found.point };
  }
}
