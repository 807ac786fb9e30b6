// The camera: a target, a distance and an orientation. It turns without limit in every direction (also across the poles), zooms to the pointer, and flies.
import { Matrix4, Quaternion, Vector3 } from "three";

const k_field_of_view = 30; // degrees, over the height of the picture: little perspective, as in engineering software
const k_turn_per_pixel = 0.008; // radians
const k_zoom_per_notch = 1.0015; // factor per unit of a wheel's delta
const k_flight = 650; // ms
const k_filled = 0.9; // share of the picture that is filled after fitting
const k_near_share = 1e-3; // relative to the distance to the target: nearer objects are not drawn

/** Returns the orientation of a camera that looks along `direction` with `up` upwards. */
export function looking(direction, up) {
  const back = direction.clone().normalize().negate();
  let right = up.clone().cross(back);
  if (right.length() < 1e-6) right = new Vector3(Math.abs(back.x) < 0.9 ? 1 : 0, Math.abs(back.x) < 0.9 ? 0 : 1, 0).cross(back);
  right.normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(right, back.clone().cross(right), back));
}

/** Directions of view by name: [along, up]. x points aft, y to the right wing, z up. */
export const k_views = {
  iso: [[1, 1, -0.75], [0, 0, 1]],
  front: [[1, 0, 0], [0, 0, 1]],
  back: [[-1, 0, 0], [0, 0, 1]],
  side: [[0, 1, 0], [0, 0, 1]],
  top: [[0, 0, -1], [0, 1, 0]],
  bottom: [[0, 0, 1], [0, 1, 0]],
};

export class Camera {
  /** camera: camera of three.js; element: receives the pointer events; changed(by_hand): called if the picture changes. */
  constructor(camera, element, changed) {
    this.camera = camera;
    this.element = element;
    this.changed = changed;
    camera.fov = k_field_of_view;
    this.target = new Vector3();
    this.distance = 1;
    this.orientation = looking(new Vector3(1, 1, -0.75), new Vector3(0, 0, 1));
    this.scene = { center: new Vector3(), radius: 1 };
    this.limits = { least: 1e-9, greatest: 1e9 };
    this.flight = null;
    this.pointers = new Map();
    this.height = 1; // height of the picture, pixels of the page
    this.n_pictures = 1; // number of pictures side by side, all from this camera
    this.listen();
  }

  /** Returns the distance from which a sphere fills the picture. */
  distance_for(radius) {
    const half = Math.atan(Math.tan(((k_field_of_view / 2) * Math.PI) / 180) * Math.min(1, this.camera.aspect));
    return radius / Math.sin(half);
  }

  /** Returns target and distance from which all points (xyz, ...) are in the picture, for this orientation. */
  framing(points, orientation) {
    const inverse = orientation.clone().invert();
    const slope_y = Math.tan(((k_field_of_view / 2) * Math.PI) / 180) * k_filled, slope_x = slope_y * this.camera.aspect;
    const v = new Vector3();
    // Each point bounds the camera by four planes, so only extremes of x - s z and so on are needed.
    const most = { left: -Infinity, right: -Infinity, down: -Infinity, up: -Infinity, near: -Infinity, far: Infinity };
    for (let k = 0; k < points.length; k += 3) {
      v.set(points[k], points[k + 1], points[k + 2]).applyQuaternion(inverse);
      most.right = Math.max(most.right, v.x + slope_x * v.z);
      most.left = Math.max(most.left, -v.x + slope_x * v.z);
      most.up = Math.max(most.up, v.y + slope_y * v.z);
      most.down = Math.max(most.down, -v.y + slope_y * v.z);
      most.near = Math.max(most.near, v.z);
      most.far = Math.min(most.far, v.z);
    }
    const z = Math.max((most.right + most.left) / (2 * slope_x), (most.up + most.down) / (2 * slope_y), most.near);
    const camera = new Vector3((most.right - most.left) / 2, (most.up - most.down) / 2, z);
    const depth = Math.max(z - (most.near + most.far) / 2, 1e-12); // the target is in the middle of the framed points, independent of other objects in the scene
    return { target: camera.clone().sub(new Vector3(0, 0, depth)).applyQuaternion(orientation), distance: depth };
  }

  /** Returns the metres at the target that a pixel shows. */
  pixel_size() {
    return (2 * this.distance * Math.tan(((k_field_of_view / 2) * Math.PI) / 180)) / this.height;
  }

  apply() {
    const { camera } = this;
    const back = new Vector3(0, 0, 1).applyQuaternion(this.orientation);
    camera.position.copy(this.target).addScaledVector(back, this.distance);
    camera.quaternion.copy(this.orientation);
    camera.near = this.distance * k_near_share;
    camera.far = camera.position.distanceTo(this.scene.center) + this.scene.radius * 1.01 + this.distance;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  /** Moves the camera: immediately, or in a flight if `is_smooth`. Omitted parts are not changed. */
  go({ target = this.target, distance = this.distance, orientation = this.orientation }, is_smooth = true) {
    this.flight = null;
    const to = { target: target.clone(), distance: this.bounded(distance), orientation: orientation.clone() };
    const is_still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!is_smooth || is_still) {
      Object.assign(this, to);
      this.changed(false);
      return;
    }
    const from = { target: this.target.clone(), distance: this.distance, orientation: this.orientation.clone() };
    this.flight = { from, to, start: performance.now() };
    this.changed(false);
  }

  bounded(distance) {
    return Math.min(Math.max(distance, this.limits.least), this.limits.greatest);
  }

  /** Makes one step of the flight at time now; returns false if there is no flight. */
  step(now) {
    if (!this.flight) return false;
    const { from, to, start } = this.flight;
    const share = Math.min(Math.max((now - start) / k_flight, 0), 1);
    const s = share * share * (3 - 2 * share);
    this.distance = from.distance * (to.distance / from.distance) ** s;
    // The target moves with the zoom, so that the destination stays in the picture.
    const ratio = to.distance / from.distance;
    const along = Math.abs(Math.log(ratio)) < 1e-3 ? s : (1 - ratio ** s) / (1 - ratio);
    this.target.copy(from.target).lerp(to.target, along);
    this.orientation.slerpQuaternions(from.orientation, to.orientation, s);
    if (share >= 1) {
      Object.assign(this, { target: to.target.clone(), distance: to.distance, orientation: to.orientation.clone() });
      this.flight = null;
    }
    return true;
  }

  /** Turns the camera: dx about the vertical axis of the world, dy about the horizontal axis of the picture. Beyond a pole the world is upside down, and dx follows the movement of the pointer. */
  turn(dx, dy) {
    const up = new Vector3(0, 1, 0).applyQuaternion(this.orientation);
    const vertical = new Quaternion().setFromAxisAngle(new Vector3(0, 0, up.z < 0 ? -1 : 1), -dx * k_turn_per_pixel);
    const horizontal = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), -dy * k_turn_per_pixel);
    this.orientation.premultiply(vertical).multiply(horizontal).normalize();
    this.by_hand();
  }

  roll(angle) {
    this.orientation.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), angle)).normalize();
    this.by_hand();
  }

  pan(dx, dy) {
    const size = this.pixel_size();
    this.target.add(new Vector3(-dx * size, dy * size, 0).applyQuaternion(this.orientation));
    this.by_hand();
  }

  /** Multiplies the distance by a factor. x, y: position in pixels from the middle of the picture, which stays unchanged. */
  zoom(factor, x = 0, y = 0) {
    const before = this.pixel_size();
    this.distance = this.bounded(this.distance * factor);
    const shift = before - this.pixel_size();
    this.target.add(new Vector3(x * shift, -y * shift, 0).applyQuaternion(this.orientation));
    this.by_hand();
  }

  by_hand() {
    this.flight = null;
    this.changed(true);
  }

  listen() {
    const { element } = this;
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    for (const name of ["pointerup", "pointercancel"]) element.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    element.addEventListener("pointermove", (event) => this.drag(event));
    element.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const box = element.getBoundingClientRect();
        const delta = event.deltaY * (event.deltaMode === 1 ? 30 : 1);
        const width = box.width / this.n_pictures;
        this.zoom(k_zoom_per_notch ** Math.max(-400, Math.min(400, delta)), ((event.clientX - box.left) % width) - width / 2, event.clientY - box.top - box.height / 2);
      },
      { passive: false },
    );
    element.addEventListener("keydown", (event) => this.key(event));
  }

  drag(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    if (others.length) {
      const before = Math.hypot(last.x - others[0].x, last.y - others[0].y), after = Math.hypot(event.clientX - others[0].x, event.clientY - others[0].y);
      this.pan(dx / 2, dy / 2);
      if (before > 0 && after > 0) this.zoom(before / after);
    } else if (event.buttons & 6 || event.shiftKey) this.pan(dx, dy);
    else if (event.altKey) this.roll(dx * k_turn_per_pixel);
    else if (dx !== 0 || dy !== 0) this.turn(dx, dy);
    last.x = event.clientX;
    last.y = event.clientY;
  }

  key(event) {
    const step = 24; // pixels that correspond to one key press
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    if (moves[event.key]) (event.shiftKey ? this.pan : this.turn).call(this, ...moves[event.key]);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.2);
    else if (event.key === "-") this.zoom(1.2);
    else return;
    event.preventDefault();
  }
}
