// How finely the picture is drawn while it moves: so that frames come smoothly, whatever the mesh and the graphics card; finely again when it rests.

const k_smooth = 40; // ms of a frame that is smooth enough
const k_rest = 300; // ms without movement until all is drawn again
const k_poll = 4; // ms between looks whether a frame is there
const k_most_wait = 5000; // ms: a frame that takes longer is not waited for
const k_many = 500000; // triangles that may be too many for a frame of which nothing is known
const k_most_frame = 1000; // ms: what would take longer (no graphics card) is thinned at rest, too
const k_other_size = 1.3; // ratio of numbers of triangles from which a picture counts as another one

/** Levels of drawing: all of it; surfaces thinned; thinned, and at half the resolution. */
export const k_levels = [{ is_thin: false, share: 1 }, { is_thin: true, share: 1 }, { is_thin: true, share: 0.5 }];

export class Pace {
  /** gl: the context; redraw(): asks for a frame. */
  constructor(gl, redraw) {
    this.gl = gl;
    this.redraw = redraw;
    this.costs = new Array(k_levels.length).fill(null); // ms of the last frame of each level
    this.size = 0; // triangles of the picture that the costs are of
    this.is_moving = false;
    this.is_waiting = false;
    this.is_whole = false; // of the next frame: all of it, whatever it takes
  }

  /** Something moves: for a moment, frames are drawn for speed. */
  move() {
    this.is_moving = true;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.is_moving = false;
      this.redraw();
    }, k_rest);
  }

  /** The next frame is drawn wholly, as for a picture to keep. */
  rest() {
    clearTimeout(this.timer);
    this.is_moving = false;
    this.is_whole = true;
  }

  /** The level of the next frame of n triangles, n_thin where surfaces are thinned: at rest all of it, unless that takes very long; else the finest that is known to be smooth, or not known yet. */
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
    // What all of it takes was measured once, perhaps while the machine was busy; thinned frames tell of now.
    const whole = measured === null && thin === null ? (n < k_many ? 0 : Infinity) : Math.min(measured ?? Infinity, thin === null ? Infinity : (thin * n) / n_thin);
    if (!this.is_moving) return whole > k_most_frame && n_thin < n ? 1 : 0;
    const smooth = this.costs.findIndex((cost, level) => (level === 0 ? whole : (cost ?? 0)) <= k_smooth);
    return smooth < 0 ? k_levels.length - 1 : smooth;
  }

  /** Behind the calls that draw a frame: notes how long the graphics card takes for it. One frame at a time is looked at. */
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
      if (is_first && level > 0 && !this.is_moving) this.redraw(); // now it is known what all of it takes
      gl.deleteSync(fence);
    };
    setTimeout(look, 0);
  }
}
