// The level of detail during movements: frames stay smooth for any mesh and graphics card, and the picture has full detail at rest.

const k_smooth = 40; // ms, longest duration of a smooth frame
const k_rest = 300; // ms without movement until the full picture is drawn
const k_poll = 4; // ms between checks for the end of a frame
const k_most_wait = 5000; // ms: the program does not wait for a longer frame
const k_many = 500000; // number of triangles that may be too many for a frame of unknown duration
const k_most_frame = 1000; // ms: if a full frame takes longer (no graphics card), surfaces are thinned at rest as well
const k_other_size = 1.3; // ratio of the numbers of triangles from which a picture counts as a different picture

/** Drawing levels: full; thinned surfaces; thinned surfaces at half the resolution. */
export const k_levels = [{ is_thin: false, share: 1 }, { is_thin: true, share: 1 }, { is_thin: true, share: 0.5 }];

export class Pace {
  /** gl: the context; redraw(): requests a frame. */
  constructor(gl, redraw) {
    this.gl = gl;
    this.redraw = redraw;
    this.costs = new Array(k_levels.length).fill(null); // ms of the last frame of each level
    this.size = 0; // number of triangles of the picture with these costs
    this.is_moving = false;
    this.is_waiting = false;
    this.is_whole = false; // the next frame has full detail, for any duration
  }

  /** Reports a movement: for a moment, frames are drawn for speed. */
  move() {
    this.is_moving = true;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.is_moving = false;
      this.redraw();
    }, k_rest);
  }

  /** Draws the next frame with full detail, for a saved picture. */
  rest() {
    clearTimeout(this.timer);
    this.is_moving = false;
    this.is_whole = true;
  }

  /** Returns the level of the next frame of n triangles, n_thin with thinned surfaces. At rest: full detail, unless that takes very long. Otherwise: the finest level that is known to be smooth or has an unknown duration. */
  level(n, n_thin) {
    if (n > this.size * k_other_size || n * k_other_size < this.size) {
      this.size = n;
      this.costs.fill(null);
    }
    if (this.is_whole) {
      this.is_whole = false;
      return 0;
    }
    const [measured, thin] = this.costs;
    // The duration of a full frame was measured once, perhaps while the machine was busy; thinned frames show the present speed.
    const whole = measured === null && thin === null ? (n < k_many ? 0 : Infinity) : Math.min(measured ?? Infinity, thin === null ? Infinity : (thin * n) / n_thin);
    if (!this.is_moving) return whole > k_most_frame && n_thin < n ? 1 : 0;
    const smooth = this.costs.findIndex((cost, level) => (level === 0 ? whole : (cost ?? 0)) <= k_smooth);
    return smooth < 0 ? k_levels.length - 1 : smooth;
  }

  /** Measures how long the graphics card takes for a frame, after the drawing calls. One frame at a time is measured. */
  measure(level) {
    if (this.is_waiting) return;
    const { gl } = this;
    const begin = performance.now();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return; // the context is lost
    gl.flush();
    this.is_waiting = true;
    const look = () => {
      const cost = performance.now() - begin;
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && cost < k_most_wait) return setTimeout(look, k_poll);
      const is_first = this.costs[level] === null;
      this.costs[level] = cost;
      this.is_waiting = false;
      if (is_first && level > 0 && !this.is_moving) this.redraw(); // now the duration of a full frame is known
      gl.deleteSync(fence);
    };
    setTimeout(look, 0);
  }
}
