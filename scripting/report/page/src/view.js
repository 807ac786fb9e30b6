// The picture: surface, one cut, markers, item under the pointer, scale bar and axes. Positions in the interface are absolute, in metres.
import { BufferAttribute, BufferGeometry, Color, ColorManagement, LinearSRGBColorSpace, Mesh, PerspectiveCamera, Points, Scene, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget } from "three";
import { Camera, k_views, looking } from "./camera.js";
import { css_colour, h, number_text } from "./dom.js";
import { ReportError } from "./errors.js";
import { picture_with } from "./picture.js";
import { draw_material, marker_material, palette_texture, pick_material, set_uniforms } from "./shaders.js";
import { first_hit, nearest_triangle, point_on } from "./triangles.js";

// Colours are final screen colours; no light is mixed in.
ColorManagement.enabled = false;

const k_most_pixels = 2; // screen pixels per pixel of the page: more cost time without a visible difference
const k_click_reach = 10; // pixels around a marker that belong to the marker
const k_click_slack = 4; // pixels that the pointer may move during a click
const k_slow_pick = 40; // ms: if picking is slower, the item under the pointer is searched only while the pointer rests
const k_rest = 160; // ms
const k_other_sides = [0.45, 1, 2]; // tangents of the angles to the wall normal for other views of a location that the body hides
const k_before_wall = 0.9; // relative to the length to the next wall, if the wall is nearer than the view distance
const k_least_place = 4e-3; // smallest radius that is shown around a location, relative to the body length: neighbours of slivers must be visible

export class Layer {
  constructor(scene) {
    this.uniforms = set_uniforms();
    this.draw = draw_material(this.uniforms);
    this.pick = pick_material(this.uniforms);
    this.scene = scene;
    this.set = null;
    this.thin = null; // the same surface with fewer triangles, for fast frames
    this.mesh = null;
  }

  show(set, position) {
    if (this.mesh) this.scene.remove(this.mesh);
    if (this.set && this.set !== set) this.set.dispose();
    this.set = set;
    this.thin = null;
    this.mesh = null;
    if (!set) return;
    this.mesh = new Mesh(set.geometry, [this.draw]);
    this.mesh.position.copy(position);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = true;
    this.show_ranges([[0, set.n]]);
    this.scene.add(this.mesh);
  }

  /** Draws only these ranges of triangles (of the thin set: thin_ranges). */
  show_ranges(ranges, thin_ranges = []) {
    this.ranges = this.set.show_ranges(ranges);
    this.thin?.show_ranges(thin_ranges);
  }

  /** Draws the thin set, if there is one, or the full set. */
  use_thin(is_thin) {
    if (this.mesh) this.mesh.geometry = (is_thin && this.thin ? this.thin : this.set).geometry;
  }

  paint(tones, palette) {
    this.uniforms.palette.value?.dispose();
    this.uniforms.palette.value = palette_texture(palette);
    this.set.set_tones(tones);
    this.thin?.set_tones(tones);
  }

  /** Returns the number of drawn triangles while the thin set is drawn. */
  n_drawn_thin() {
    if (!this.thin) return this.n_drawn();
    return this.mesh?.visible ? this.thin.n : 0;
  }

  n_drawn() {
    return this.mesh?.visible ? this.ranges.reduce((sum, [from, to]) => sum + to - from, 0) : 0;
  }
}

export class View {
  /** Adds the canvas to `container`. \throws ReportError without WebGL 2. */
  constructor(container, origin, handlers) {
    this.container = container;
    this.handlers = handlers;
    this.origin = new Vector3(...origin);
    this.canvas = h("canvas.view_canvas", { tabindex: "0", "aria-label": "The mesh in three dimensions. Arrow keys turn, Shift and arrow keys move, plus and minus zoom." });
    const context = this.canvas.getContext("webgl2", { antialias: true, powerPreference: "high-performance" });
    if (!context) throw new ReportError("The picture cannot be drawn: this browser has no WebGL 2 (switched off, or no driver of the graphics card). The tables beside it are complete.");
    container.prepend(this.canvas);
    this.canvas.addEventListener("webglcontextlost", () => handlers.lost?.("The graphics card released the memory of the picture: reload the page to see it again."));
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, k_most_pixels));
    this.scene = new Scene();
    this.lens = new PerspectiveCamera();
    this.camera = new Camera(this.lens, this.canvas, (by_hand) => {
      if (by_hand) {
        this.framed = null;
        handlers.moved?.();
      }
      this.moves();
      this.request();
    });
    this.surface = new Layer(this.scene);
    this.cut = new Layer(this.scene);
    this.cut.uniforms.shading.value = 0;
    this.cut.uniforms.fade_together.value = 0;
    this.markers = null;
    this.marker_list = [];
    this.pin = null;
    this.symmetry_normal = new Vector3();
    this.knows_fluid = false;
    this.framed = null; // points to which the picture was last fitted, until the camera moves for another reason
    this.pick_target = new WebGLRenderTarget(1, 1);
    this.overlay();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(container);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.restyle());
    this.restyle();
    this.resize();
  }

  overlay() {
    this.pin_element = h("div.pin", { hidden: true }, h("div.pin_ring"), h("div.pin_text"));
    this.scale_bar = h("div.scale_bar", null, h("span"), h("i"));
    this.axes = h("div.axes", { "aria-hidden": "true" });
    this.axes.innerHTML = '<svg viewBox="-40 -40 80 80" width="72" height="72"></svg>';
    this.container.append(this.pin_element, this.scale_bar, this.axes);
  }

  restyle() {
    this.renderer.setClearColor(new Color().setStyle(css_colour("--view_background"), ""), 1);
    const edge = new Color().setStyle(css_colour("--mesh_edge"), "");
    for (const layer of [this.surface, this.cut]) layer.uniforms.edge_colour.value = [edge.r, edge.g, edge.b];
    this.request();
  }

  resize() {
    const width = Math.max(1, this.container.clientWidth), height = Math.max(1, this.container.clientHeight);
    this.renderer.setSize(width, height, false);
    this.camera.height = height; // reading the height from the page in every frame would force a new layout each time
    const aspect = width / this.camera.n_pictures / height;
    const is_other = this.lens.aspect !== aspect;
    this.lens.aspect = aspect;
    if (is_other && this.framed) this.fit(this.framed, false);
    this.request();
  }

  /** Called if the camera moves. The workbench draws faster during movements. */
  moves() {}

  local(position) {
    return new Vector3(...position).sub(this.origin);
  }

  absolute(point) {
    return point.clone().add(this.origin).toArray();
  }

  request() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame((now) => {
      this.waiting = 0;
      if (this.camera.step(now)) {
        this.moves();
        this.request();
      }
      this.draw();
    });
  }

  draw() {
    this.camera.apply();
    for (const layer of [this.surface, this.cut]) {
      layer.uniforms.near.value = this.lens.near;
      layer.uniforms.far.value = this.lens.far;
    }
    this.renderer.render(this.scene, this.lens);
    this.draw_pin();
    this.draw_axes();
    this.draw_scale_bar();
  }

  draw_pin() {
    this.pin_element.hidden = !this.pin;
    if (!this.pin) return;
    const at = this.on_screen(this.pin.at);
    this.pin_element.hidden = !at;
    if (at) this.pin_element.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
  }

  /** Returns the pixels of an absolute position, in one of the pictures side by side; null behind the camera or outside of the picture. */
  on_screen(position, picture = this.camera.n_pictures - 1) {
    const point = this.local(position).applyMatrix4(this.lens.matrixWorldInverse);
    if (point.z >= 0) return null;
    point.applyMatrix4(this.lens.projectionMatrix);
    if (Math.abs(point.x) > 1 || Math.abs(point.y) > 1) return null;
    const width = this.canvas.clientWidth / this.camera.n_pictures;
    return [((point.x + 1) / 2 + picture) * width, ((1 - point.y) / 2) * this.canvas.clientHeight];
  }

  draw_axes() {
    if (this.drawn_axes?.equals(this.camera.orientation)) return;
    this.drawn_axes = this.camera.orientation.clone();
    const inverse = this.camera.orientation.clone().invert();
    const arms = [["x", "#d0453a"], ["y", "#3c9a4e"], ["z", "#3f78c9"]].map(([name, colour], k) => ({ name, colour, v: new Vector3().setComponent(k, 1).applyQuaternion(inverse) }));
    arms.sort((a, b) => a.v.z - b.v.z);
    this.axes.firstChild.innerHTML = arms
      .map(({ name, colour, v }) => {
        const x = v.x * 25, y = -v.y * 25;
        return `<line x1="0" y1="0" x2="${x}" y2="${y}" stroke="${colour}" stroke-width="2.4" stroke-linecap="round"/><text x="${x * 1.34}" y="${y * 1.34}" fill="${colour}">${name}</text>`;
      })
      .join("");
  }

  draw_scale_bar() {
    const wanted = this.camera.pixel_size() * 110;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((m) => m * power).find((l) => l <= wanted) ?? power;
    const [text, bar] = this.scale_bar.children;
    const [factor, unit] = length >= 1 ? [1, "m"] : length >= 1e-3 ? [1e3, "mm"] : [1e6, "\u00b5m"];
    text.textContent = `${number_text(Number((length * factor).toPrecision(2)))} ${unit}`;
    bar.style.width = `${(length / this.camera.pixel_size()).toFixed(1)}px`;
  }

  // ---- visible objects

  set_surface(set) {
    this.surface.show(set, new Vector3());
    this.surface.uniforms.outward.value = set.outward;
    this.request();
  }

  /** Draws these ranges of triangles of the visible patches, which define the extent of the scene. */
  show_ranges(ranges) {
    this.surface.show_ranges(ranges);
    this.request();
  }

  set_scene(sphere) {
    this.camera.scene = sphere;
    this.camera.limits = { least: Math.max(sphere.radius * 1e-9, 1e-12), greatest: sphere.radius * 60 };
  }

  set_cut(set, base) {
    this.cut.show(set, base ? this.local(base) : new Vector3());
    this.request();
  }

  /** Hides the surface on the side to which `normal` points; null shows the complete surface. */
  set_clip(plane) {
    const clip = this.surface.uniforms.clip;
    if (!plane) clip.value = [0, 0, 0, 1];
    else clip.value = [...plane.normal, new Vector3(...plane.normal).dot(this.local(plane.origin))];
    this.request();
  }

  set_edges(surface, cut) {
    this.surface.uniforms.edge_strength.value = surface ? 0.5 : 0;
    this.cut.uniforms.edge_strength.value = cut ? 0.7 : 0;
    this.request();
  }

  show_surface(is_shown) {
    if (this.surface.mesh) this.surface.mesh.visible = is_shown;
    this.request();
  }

  /** Shows markers through all objects; list of {at, colour: [r, g, b]}. */
  set_markers(list) {
    if (this.markers) {
      this.scene.remove(this.markers);
      this.markers.geometry.dispose();
    }
    this.marker_list = list;
    this.markers = null;
    if (list.length) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(list.flatMap((m) => this.local(m.at).toArray())), 3));
      geometry.setAttribute("colour_of", new BufferAttribute(new Float32Array(list.flatMap((m) => m.colour.map((c) => c / 255))), 3));
      this.marker_material ??= marker_material();
      this.marker_material.uniforms.pixels.value = 11 * this.renderer.getPixelRatio();
      this.markers = new Points(geometry, this.marker_material);
      this.markers.frustumCulled = false;
      this.markers.renderOrder = 10;
      this.scene.add(this.markers);
    }
    this.request();
  }

  /** Marks the selected location by a ring with a text; null removes the mark. */
  set_pin(pin) {
    this.pin = pin;
    if (pin) {
      this.pin_element.style.setProperty("--pin", pin.colour);
      this.pin_element.lastChild.replaceChildren(h("b", null, pin.title), h("span", null, pin.text));
    }
    this.request();
  }

  // ---- camera

  look_along(name, points, is_smooth = true) {
    const [from, up] = k_views[name];
    const along = new Vector3(...from);
    const away = -along.dot(this.symmetry_normal); // half models are viewed from the side of the fluid
    if (away > 0) along.addScaledVector(this.symmetry_normal, 2 * away);
    this.fit(points, is_smooth, looking(along, new Vector3(...up)));
  }

  /** Fits all points (xyz, ..., relative to the origin) into the picture. */
  fit(points, is_smooth = true, orientation = this.camera.orientation) {
    this.camera.go({ ...this.camera.framing(points, orientation), orientation }, is_smooth);
    this.framed = points;
  }

  fly_to_cut(cut, is_smooth = true) {
    const normal = new Vector3(...cut.normal).normalize();
    const up = Math.abs(normal.z) > 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
    const orientation = looking(normal.negate(), up);
    this.framed = null;
    this.camera.go({ target: this.local(cut.focus.center), distance: this.camera.distance_for(cut.focus.radius), orientation }, is_smooth);
  }

  /** Views a location from outside the body, along the normal of the nearest triangle. Valid meshes define the side of the fluid (`knows_fluid`; their faces point into the
   *  fluid); for other meshes the view is from a side without obstacles. The view is about 20 triangles wide. */
  fly_to_place(position, length, ranges, is_smooth = true) {
    const target = this.local(position);
    const near = this.surface.set ? nearest_triangle(this.surface.set, target, ranges) : null;
    let distance = this.camera.distance_for(length * 0.02), orientation = this.camera.orientation;
    if (near && near.distance < length * 0.5) {
      const outwards = this.outwards_at(target, near, ranges);
      distance = this.camera.distance_for(Math.max(near.size * 10, near.distance * 3, length * k_least_place));
      // A view along the normal looks flat; an angle of about 25 degrees shows relief. If the body hides the location, the first free direction is used, or the direction with the longest free view.
      const side = new Vector3(0, 0, 1).cross(outwards).multiplyScalar(0.35).add(new Vector3(0, 0, 0.25));
      const { towards, free } = this.free_side(target, outwards, side, distance, ranges, near);
      if (free < distance) distance = Math.max(k_before_wall * free, near.size); // in a slot
      orientation = looking(towards.negate(), new Vector3(0, 0, 1));
    }
    this.framed = null;
    this.camera.go({ target, distance, orientation }, is_smooth);
  }

  /** Returns the length from a location to the next wall in a direction. */
  free_length(target, direction, near, ranges) {
    return first_hit(this.surface.set, target, direction, ranges, near.distance * 1e-3 + near.size * 1e-3);
  }

  outwards_at(target, near, ranges) {
    const one = near.normal, other = near.normal.clone().negate();
    if (this.knows_fluid) return other;
    return this.free_length(target, other, near, ranges) > this.free_length(target, one, near, ranges) ? other : one;
  }

  /** Returns the direction from which a location is viewed: `side` off its normal if nothing is in between over `distance`, else the first free direction, else the direction with the longest free view. {towards, free: m to the next wall} */
  free_side(target, outwards, side, distance, ranges, near) {
    const across = new Vector3(0, 0, 1).cross(outwards);
    if (across.length() < 1e-6) across.set(1, 0, 0);
    across.normalize();
    const around = k_other_sides.flatMap((tilt) => [...Array(8).keys()].map((k) => across.clone().applyAxisAngle(outwards, (k * Math.PI) / 4).multiplyScalar(tilt)));
    let best = { towards: null, free: -1 };
    for (const aside of [side, new Vector3(), ...around]) {
      const towards = outwards.clone().add(aside).normalize();
      const free = this.free_length(target, towards, near, ranges);
      if (free > best.free) best = { towards, free };
      if (best.free > distance) break;
    }
    return best;
  }

  // ---- item under the pointer

  /** Returns {index, triangle, item, at, point} of the first item at pixels of the canvas, in layers[index]; or null. The picture is drawn once more, one pixel, with a separate colour for each triangle. */
  hit(layers, x, y) {
    const size = this.renderer.getSize(new Vector2());
    size.x /= this.camera.n_pictures;
    x %= size.x;
    this.camera.apply();
    this.lens.setViewOffset(size.x, size.y, Math.floor(x), Math.floor(y), 1, 1);
    const first = [];
    let n = 0;
    for (const layer of layers) {
      first.push(n);
      if (!layer.mesh) continue;
      layer.use_thin(false);
      layer.uniforms.id_offset.value = n;
      layer.mesh.material = [layer.pick];
      n += layer.set.n;
    }
    if (this.markers) this.markers.visible = false;
    const clear = this.renderer.getClearColor(new Color());
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.setRenderTarget(this.pick_target);
    this.renderer.clear();
    this.renderer.render(this.scene, this.lens);
    const bytes = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.pick_target, 0, 0, 1, 1, bytes);
    this.renderer.setRenderTarget(null);
    this.renderer.setClearColor(clear, 1);
    for (const layer of layers) if (layer.mesh) layer.mesh.material = [layer.draw];
    if (this.markers) this.markers.visible = true;
    this.lens.clearViewOffset();
    this.lens.updateProjectionMatrix();
    const id = bytes[0] + bytes[1] * 256 + bytes[2] * 65536 + bytes[3] * 16777216 - 1;
    const index = id < 0 ? -1 : layers.findIndex((layer, k) => layer.mesh && id >= first[k] && id < first[k] + layer.set.n);
    if (index < 0) return null;
    const layer = layers[index], triangle = id - first[index];
    const direction = new Vector3((2 * (Math.floor(x) + 0.5)) / size.x - 1, 1 - (2 * (Math.floor(y) + 0.5)) / size.y, 0.5).unproject(this.lens).sub(this.lens.position).normalize();
    const point = point_on(layer.set, triangle, this.lens.position.clone().sub(layer.mesh.position), direction).add(layer.mesh.position);
    return { index, triangle, item: layer.set.item[triangle], at: this.absolute(point), point };
  }

  /** Returns {layer: "surface" | "cut", item, at} at pixels of the canvas, or null. */
  pick(x, y) {
    const found = this.hit([this.surface, this.cut], x, y);
    return found && { layer: found.index === 0 ? "surface" : "cut", item: found.item, at: found.at, point: found.point };
  }

  /** Returns the index of the marker at pixels of the canvas, or -1. */
  marker_at(x, y) {
    let best = -1, least = k_click_reach;
    this.marker_list.forEach((marker, k) => {
      const at = this.on_screen(marker.at);
      const away = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
      if (away < least) {
        least = away;
        best = k;
      }
    });
    return best;
  }

  listen() {
    const { canvas } = this;
    const pixels = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    let down = null, resting = 0, last_cost = 0;
    const hover = (x, y) => {
      const start = performance.now();
      const found = this.pick(x, y);
      last_cost = performance.now() - start;
      this.handlers.hovered?.(found);
    };
    canvas.addEventListener("pointerdown", (event) => {
      down = pixels(event);
      canvas.focus({ preventScroll: true });
    });
    canvas.addEventListener("pointerup", (event) => {
      const [x, y] = pixels(event);
      if (!down || Math.hypot(x - down[0], y - down[1]) > k_click_slack || event.button !== 0) return;
      down = null;
      const marker = this.marker_at(x, y);
      if (marker >= 0) this.handlers.marker_clicked?.(marker);
      else this.handlers.clicked?.(this.pick(x, y));
    });
    canvas.addEventListener("dblclick", (event) => {
      const found = this.pick(...pixels(event));
      if (!found) return;
      this.framed = null;
      this.camera.go({ target: found.point });
      this.handlers.moved?.();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons || this.camera.flight) return;
      const [x, y] = pixels(event);
      clearTimeout(resting);
      if (last_cost < k_slow_pick) {
        if (this.hovering) return;
        this.hovering = requestAnimationFrame(() => {
          this.hovering = 0;
          hover(x, y);
        });
      } else resting = setTimeout(() => hover(x, y), k_rest);
    });
    canvas.addEventListener("pointerleave", () => {
      clearTimeout(resting);
      this.handlers.hovered?.(null);
    });
  }

  /** Returns a promise of the picture as a PNG (a Blob), with additional elements over it. */
  picture(elements) {
    this.draw(); // in the same task, because the canvas is empty afterwards
    return picture_with(this.canvas, [...elements, this.scale_bar, this.axes, this.pin_element]);
  }

  /** Returns the share of pixels that are not background, and the number of distinct colours in a sample; for tests. */
  pixels() {
    this.draw();
    const context = this.renderer.getContext();
    const width = context.drawingBufferWidth, height = context.drawingBufferHeight;
    const bytes = new Uint8Array(4 * width * height);
    context.readPixels(0, 0, width, height, context.RGBA, context.UNSIGNED_BYTE, bytes);
    const background = new Color().setStyle(css_colour("--view_background"), "");
    const clear = [background.r, background.g, background.b].map((c) => Math.round(c * 255));
    const colours = new Set();
    let n_drawn = 0;
    for (let k = 0; k < bytes.length; k += 4) {
      if (Math.abs(bytes[k] - clear[0]) + Math.abs(bytes[k + 1] - clear[1]) + Math.abs(bytes[k + 2] - clear[2]) > 6) ++n_drawn;
      if (k % 28 === 0) colours.add((bytes[k] << 16) | (bytes[k + 1] << 8) | bytes[k + 2]);
    }
    return { width, height, share: n_drawn / (width * height), colours: colours.size };
  }
}
